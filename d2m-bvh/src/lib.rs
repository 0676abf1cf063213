//! Triangle meshes, bounding-volume trees and certified tree-pair queries: time of contact, collide, distance.
