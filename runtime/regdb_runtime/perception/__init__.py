"""Perception: image and prompt to text, text to facts with evidence, facts fused over time; silence is unknown."""
