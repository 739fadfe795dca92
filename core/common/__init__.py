"""What every other folder uses: errors, progress and cancel, worker threads, scratch memory, layers in memory and their fields."""
