"""Phases of the work and who runs them: threads of this process, worker processes, or the workers of a Dask cluster.

In: a `Phase`, a public function with what it reads from and plain settings, and the sections of road it is to work on. Out: its results in
the order of the sections, the same from every `Executor`.
"""
