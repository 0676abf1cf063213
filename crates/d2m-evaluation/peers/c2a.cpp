// C2A on trials: controlled conservative advancement between the end poses, with linear translation and one rotation.
//
// usage: c2a A.obj B.obj TRIALS.csv [LIMIT [TOLERANCE]]
// build: README.md
//
// Prints `trial,toc,microseconds,separation`: the time is infinite where C2A reports no collision, the separation is what PQP's distance is
// there. The tolerance of distance and of time is 1e-4 as in C2A's own `C2A_Solve`, unless another one is given.
#include "C2A/C2A.h"
#include "C2A/InterpMotion.h"
#include "trials.h"

#include <unistd.h>

static C2A_Model* model(const Mesh& mesh) {
    auto* made = new C2A_Model;
    made->BeginModel(static_cast<int>(mesh.triangles.size()));
    int number = 0;
    for (const auto& [i, j, k] : mesh.triangles)
        made->AddTri(mesh.vertices[i].data(), mesh.vertices[j].data(), mesh.vertices[k].data(), number++, i, j, k);
    made->EndModel();
    return made;
}

// The motion of a body over [0, 1]; trials turn by less than half a circle, so the end poses say it all.
static CInterpMotion_Linear motion(const Body& body) {
    double r0[3][3], t0[3], r1[3][3], t1[3];
    body.pose(0.0, r0, t0);
    body.pose(1.0, r1, t1);
    return CInterpMotion_Linear(r0, t0, r1, t1);
}

int main(int count, char** words) {
    if (count < 4) fail("usage: c2a A.obj B.obj TRIALS.csv [LIMIT [TOLERANCE]]");
    // The library prints to standard output: rows go to a copy of it.
    FILE* rows = fdopen(dup(STDOUT_FILENO), "w");
    if (!rows || !std::freopen("/dev/null", "w", stdout)) fail("no standard output");
    const Mesh meshes[2] = {load(words[1]), load(words[2])};
    C2A_Model *a = model(meshes[0]), *b = model(meshes[1]);
    const std::size_t limit = count > 4 ? std::strtoul(words[4], nullptr, 10) : SIZE_MAX;
    const double tolerance = count > 5 ? std::strtod(words[5], nullptr) : 1e-4;
    std::fprintf(rows, "trial,toc,microseconds,separation\n");
    std::size_t index = 0;
    for (const Trial& trial : trials(words[3], limit)) {
        CInterpMotion_Linear of_a = motion(trial[0]), of_b = motion(trial[1]);
        of_a.m_toc_delta = of_b.m_toc_delta = tolerance;
        C2A_TimeOfContactResult found;
        // Where its first step begins; as its own demonstration does.
        found.last_triA = a->last_tri;
        found.last_triB = b->last_tri;
        // Left as it is where the loop of the library ends by its count of steps.
        found.collisionfree = false;
        const double clock = clocked([&] { C2A_QueryTimeOfContact(&of_a, &of_b, &found, a, b, tolerance, tolerance, 0); });
        const double toc = found.collisionfree ? INFINITY : static_cast<double>(found.toc);
        double separation = NAN;
        if (std::isfinite(toc)) {
            double r[2][3][3], x[2][3];
            for (int k = 0; k < 2; k++) trial[k].pose(toc, r[k], x[k]);
            PQP_DistanceResult apart;
            PQP_Distance(&apart, r[0], x[0], a, r[1], x[1], b, 0.0, 0.0);
            separation = apart.Distance();
        }
        std::fprintf(rows, "%zu,%s,%.2f,%.3e\n", index++, number(toc).c_str(), clock, separation);
        std::fflush(rows);
    }
}
