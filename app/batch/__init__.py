"""Many meshes in one go: what a job says, who draws it, and what is kept of it."""
