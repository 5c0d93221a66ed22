"""Where shading models fail: the report, its picture, its page, its files."""
