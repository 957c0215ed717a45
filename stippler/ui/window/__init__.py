"""The window: GLFW, input as events, ImGui on it, and scripted hands for tests."""
