"""Shared by all folders: errors, progress and cancellation, worker threads, working memory, layers in memory and their fields.

In: arrays, items of work and settings of any stage. Out: ordered results, `Features` and `RoadExtractionError`.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "arrays": (
        "Rows", "above_least", "ascending", "bucket_argsort", "decimate_cells", "linked_groups", "order_by", "quantile_in_order",
        "quantiles", "ranked"),
    "errors": ("Cancelled", "RoadExtractionError"),
    "features": ("Features", "Field"),
    "layer_rows": ("LayerRows", "column"),
    "parallel": ("ScratchBuffers", "cancellation_scope", "check_cancelled", "ordered_map", "trim_heap"),
    "progress": ("Progress", "RemainingTime"),
    "setting": ("Limits", "check_limits", "limits_of"),
})
