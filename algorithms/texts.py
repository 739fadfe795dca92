"""What users read, in their language; the core, which writes reports, holds what sets it."""

from ..core.common.texts import set_translation, told, tr

__all__ = ["set_translation", "told", "tr"]
