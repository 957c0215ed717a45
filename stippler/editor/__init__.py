"""The editor without a window: session, tools, selection, commands; no glfw, no imgui, no GL."""
