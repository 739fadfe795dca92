"""Processing's dialogs as this plugin shows them: one place for all results, a folder or a database, and batches."""
