"""Window, input, tools and panels: the only place that knows glfw and imgui."""
