"""Shared by all folders: errors, progress and cancellation, worker threads, working memory, layers in memory and their fields.

In: arrays, items of work and settings of any stage. Out: ordered results, `Features` and `RoadExtractionError`.
"""
