// PQP on trials: conservative advancement over its distance, and one collision and one distance query at the time that this finds.
//
// usage: pqp A.obj B.obj TRIALS.csv [LIMIT]
// build: README.md
//
// Prints `trial,advance_toc,advance_microseconds,collide_microseconds,distance_microseconds`. A static query is repeated from its own
// warm start, the least time counts; `nan` where the bodies do not meet.
#include "PQP.h"
#include "trials.h"

// Advancement ends at this distance, as in the other peers.
static const double NEAR = 1e-9;
static const int ROUNDS = 5;

static PQP_Model* model(const Mesh& mesh) {
    auto* made = new PQP_Model;
    made->BeginModel(static_cast<int>(mesh.triangles.size()));
    int number = 0;
    for (const auto& [i, j, k] : mesh.triangles)
        made->AddTri(mesh.vertices[i].data(), mesh.vertices[j].data(), mesh.vertices[k].data(), number++);
    made->EndModel();
    return made;
}

// Both bodies at one time.
struct Placed {
    double rotation[2][3][3], position[2][3];

    Placed(const Trial& trial, double t) {
        for (int k = 0; k < 2; k++) trial[k].pose(t, rotation[k], position[k]);
    }
};

static double distance(Placed& at, PQP_Model* a, PQP_Model* b) {
    PQP_DistanceResult found;
    PQP_Distance(&found, at.rotation[0], at.position[0], a, at.rotation[1], at.position[1], b, 0.0, 0.0);
    return found.Distance();
}

static bool collide(Placed& at, PQP_Model* a, PQP_Model* b) {
    PQP_CollideResult found;
    PQP_Collide(&found, at.rotation[0], at.position[0], a, at.rotation[1], at.position[1], b, PQP_FIRST_CONTACT);
    return found.Colliding();
}

template <class Query>
static double least(Query query) {
    double best = INFINITY;
    for (int round = 0; round < ROUNDS; round++) best = std::fmin(best, clocked(query));
    return best;
}

int main(int count, char** words) {
    if (count < 4) fail("usage: pqp A.obj B.obj TRIALS.csv [LIMIT]");
    const Mesh meshes[2] = {load(words[1]), load(words[2])};
    PQP_Model *a = model(meshes[0]), *b = model(meshes[1]);
    const std::size_t limit = count > 4 ? std::strtoul(words[4], nullptr, 10) : SIZE_MAX;
    std::printf("trial,advance_toc,advance_microseconds,collide_microseconds,distance_microseconds\n");
    std::size_t index = 0;
    for (const Trial& trial : trials(words[3], limit)) {
        const Body &of_a = trial[0], &of_b = trial[1];
        double speed = std::hypot(of_a.v[0] - of_b.v[0], of_a.v[1] - of_b.v[1], of_a.v[2] - of_b.v[2]);
        for (int k = 0; k < 2; k++)
            speed += std::hypot(trial[k].w[0], trial[k].w[1], trial[k].w[2]) * meshes[k].radius();
        double toc = INFINITY;
        const double advance = clocked([&] {
            for (double t = 0.0; t < 1.0;) {
                Placed at(trial, t);
                const double gap = distance(at, a, b);
                if (gap <= NEAR) {
                    toc = t;
                    return;
                }
                // The last part in 10⁹ covers the roundings of the distance.
                t += gap * (1.0 - 1e-9) / speed;
            }
        });
        double collision = NAN, apart = NAN;
        if (std::isfinite(toc)) {
            Placed at(trial, toc);
            collision = least([&] { collide(at, a, b); });
            apart = least([&] { distance(at, a, b); });
        }
        std::printf("%zu,%s,%.2f,%.2f,%.2f\n", index++, number(toc).c_str(), advance, collision, apart);
        std::fflush(stdout);
    }
}
