// Included before each file of C2A: what it takes from PQP and PQP's header does not declare.
#pragma once
#include "PQP.h"
PQP_REAL TriDistance(PQP_REAL R[3][3], PQP_REAL T[3], Tri* t1, Tri* t2, PQP_REAL p[3], PQP_REAL q[3]);
