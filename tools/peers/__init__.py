"""The programs that ours is timed beside; nothing of the plugin needs them."""
