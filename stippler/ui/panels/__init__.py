"""Panels: functions that draw one section each and call the session or a command."""
