"""The paper's methods over a drawing: first dots, relaxation, tone."""
