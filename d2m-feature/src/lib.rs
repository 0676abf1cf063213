//! Certified first contact of moving features: point/triangle, edge/edge, sphere/sphere; static triangle distance.
