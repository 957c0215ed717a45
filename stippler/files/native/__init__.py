"""The program's own files: the container of a drawing, the journal of its edits, recovery."""
