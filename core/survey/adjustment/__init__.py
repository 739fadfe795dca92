"""Several passes over one road brought into agreement.

In: a `Survey` whose passes lie apart. Out: shifts along each pass, by which its points and its track are corrected.
"""
