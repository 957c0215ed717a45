"""What the pointer does with the chosen brush: small states, without a window, GL or ImGui."""
