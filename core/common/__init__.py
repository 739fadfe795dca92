"""Shared by all folders: errors, progress and cancellation, worker threads, working memory, layers in memory and their fields.

In: arrays, items of work and settings of any stage. Out: ordered results, `Features` and `RoadExtractionError`.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "errors": ("Cancelled", "RoadExtractionError"),
    "features": ("Features", "Field"),
    "groups": ("linked_groups",),
    "memory": ("ScratchBuffers", "trim_heap"),
    "order_statistics": ("above_least", "ascending", "bucket_argsort", "decimate_cells", "order_by", "quantile_in_order", "quantiles", "ranked"),
    "parallel": ("cancellation_scope", "check_cancelled", "ordered_map"),
    "progress": ("Progress", "RemainingTime"),
    "rows": ("Rows",),
    "setting": ("Limits", "check_limits", "limits_of"),
})
