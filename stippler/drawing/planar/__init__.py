"""Areas as faces over shared borders: values, edits that return new values, and questions.

Each border between two areas is one arc, stored once; so neighbours cannot drift apart.
"""
