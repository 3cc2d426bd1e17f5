"""Members cut into load elements and strips, and the motion of points on a rigid body."""
