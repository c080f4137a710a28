"""Contact: what the membrane lies on, ends on or passes through, for one state."""
