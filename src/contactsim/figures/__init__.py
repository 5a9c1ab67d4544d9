"""One module a chapter, one function a figure."""
