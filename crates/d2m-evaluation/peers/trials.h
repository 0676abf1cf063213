// What the C++ peers share: meshes and trials of the bench, poses of constant twists, a clock.
#pragma once
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using Vec = std::array<double, 3>;

struct Mesh {
    std::vector<Vec> vertices;
    std::vector<std::array<int, 3>> triangles;

    // The largest distance of a vertex from the origin of the body.
    double radius() const {
        double most = 0.0;
        for (const Vec& v : vertices) most = std::fmax(most, std::hypot(v[0], v[1], v[2]));
        return most;
    }
};

[[noreturn]] inline void fail(const std::string& what) {
    std::fprintf(stderr, "%s\n", what.c_str());
    std::exit(2);
}

inline Mesh load(const std::string& path) {
    std::ifstream file(path);
    if (!file) fail(path + ": cannot be read");
    Mesh mesh;
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        if (kind == "v") {
            Vec v;
            words >> v[0] >> v[1] >> v[2];
            mesh.vertices.push_back(v);
        } else if (kind == "f") {
            std::array<int, 3> f;
            words >> f[0] >> f[1] >> f[2];
            for (int& index : f) index -= 1;
            mesh.triangles.push_back(f);
        }
    }
    return mesh;
}

// A body at time 0 and its velocities: quaternion (w, x, y, z), position, velocity, angular velocity.
struct Body {
    double q[4], x[3], v[3], w[3];

    // Row-major rotation and position at a time.
    void pose(double t, double rotation[3][3], double position[3]) const {
        const double rate = std::hypot(w[0], w[1], w[2]);
        const double half = 0.5 * rate * t, s = rate > 0.0 ? std::sin(half) / rate : 0.0;
        const double turn[4] = {std::cos(half), s * w[0], s * w[1], s * w[2]};
        const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        const double b[4] = {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
        const double W = turn[0] * b[0] - turn[1] * b[1] - turn[2] * b[2] - turn[3] * b[3];
        const double X = turn[0] * b[1] + turn[1] * b[0] + turn[2] * b[3] - turn[3] * b[2];
        const double Y = turn[0] * b[2] - turn[1] * b[3] + turn[2] * b[0] + turn[3] * b[1];
        const double Z = turn[0] * b[3] + turn[1] * b[2] - turn[2] * b[1] + turn[3] * b[0];
        const double r[3][3] = {{1 - 2 * (Y * Y + Z * Z), 2 * (X * Y - W * Z), 2 * (X * Z + W * Y)},
                                {2 * (X * Y + W * Z), 1 - 2 * (X * X + Z * Z), 2 * (Y * Z - W * X)},
                                {2 * (X * Z - W * Y), 2 * (Y * Z + W * X), 1 - 2 * (X * X + Y * Y)}};
        for (int i = 0; i < 3; i++) {
            position[i] = x[i] + t * v[i];
            for (int j = 0; j < 3; j++) rotation[i][j] = r[i][j];
        }
    }
};

using Trial = std::array<Body, 2>;

inline std::vector<Trial> trials(const std::string& path, std::size_t limit) {
    std::ifstream file(path);
    if (!file) fail(path + ": cannot be read");
    std::vector<Trial> all;
    std::string line;
    while (all.size() < limit && std::getline(file, line)) {
        for (char& c : line) c = c == ',' ? ' ' : c;
        std::istringstream numbers(line);
        Trial trial;
        for (Body& body : trial) {
            for (double& n : body.q) numbers >> n;
            for (double* part : {body.x, body.v, body.w})
                for (int k = 0; k < 3; k++) numbers >> part[k];
        }
        if (!numbers) fail(path + ": line " + std::to_string(all.size() + 1) + " has fewer than 26 numbers");
        all.push_back(trial);
    }
    return all;
}

// Microseconds of a call.
template <class Work>
double clocked(Work work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

// A time of contact as Python and Rust read it.
inline std::string number(double x) {
    if (std::isinf(x)) return "inf";
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
}
