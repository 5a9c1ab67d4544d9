"""What acts between surfaces: traction from gap."""
