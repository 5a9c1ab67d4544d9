"""Coverage factors and relations of cost, measured on random scenes and fitted; and trials of error control."""
