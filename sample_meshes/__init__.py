"""Small meshes to try the program on; what each is stands in catalogue.toml and SOURCES.md."""
