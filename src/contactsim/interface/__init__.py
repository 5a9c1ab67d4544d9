"""Effects between surfaces: traction from gap."""
