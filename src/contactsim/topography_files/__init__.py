"""Heights and spacings in files of any layout: arrays in nm, as the file has them."""
