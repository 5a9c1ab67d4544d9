"""Hard cases, and how every solver stands up to them."""
