"""What executing an action means, by the lifted model alone; shares no code with grounding or search."""
