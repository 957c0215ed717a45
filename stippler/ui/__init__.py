"""Window, input, tools and panels: the only place that knows glfw and imgui."""

from stippler.hidden_import import hidden

with hidden(
    "cffi"
):  # glfw needs it for Vulkan alone, and it takes longer to import than glfw itself
    import imgui_bundle as imgui_bundle
