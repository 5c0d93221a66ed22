"""The reference for local models: a diffusion profile gathered over the whole mesh.

M(x) = int E F_t(N.w) max(N.w, 0) V R(|x - y|) dA(y), summed over lights. `patches` samples what
enters, `octree` groups it, `kernel` says how large a group may be at each distance and `exitance`
adds up.
"""
