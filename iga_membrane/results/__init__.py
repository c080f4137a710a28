"""What is read off a state: areas, lines, angles, forces; nothing moves."""
