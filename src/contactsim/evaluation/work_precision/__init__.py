"""Work-precision studies: error against cost for every solver."""
