// accuracy FIRST LAST [affine] [clipped] [ENGINE …]: the random cases FIRST … LAST − 1, in a variant or as they are,
// measured by engines against the reference, one line per case and engine, then maxima and medians. "seen" is
// Σv / max v: about how many voxels make up the figures.
// ENGINE: cpu, cpu-high, gl, gl-high, slices, slices-high; default cpu cpu-high. The reference's fields are kept in the
// folder for temporary files, so that a second run takes seconds.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "render/gl/gl_engines.h"
#include "support/disagreement.h"
#include "support/random_cases.h"

using namespace pellucid;
using namespace pellucid::test;

namespace {

/// FNV-1a over everything that the reference's field depends on, so that a changed generator finds no stale field.
class Fingerprint {
public:
    void add(double value) {
        unsigned char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        for (const unsigned char b : bytes) m_hash = (m_hash ^ b) * 1099511628211ull;
    }
    void add(const Vec3& v) {
        for (int a = 0; a < 3; ++a) add(v[a]);
    }
    std::uint64_t value() const { return m_hash; }

private:
    std::uint64_t m_hash = 14695981039346656037ull;
};

std::uint64_t fingerprintOf(const RandomCase& c) {
    Fingerprint print;
    const Geometry& g = c.volume->geometry();
    print.add(Vec3(g.dims));
    print.add(g.spacing);
    print.add(g.origin);
    for (int a = 0; a < 3; ++a) print.add(g.directions[a]);
    for (std::size_t i = 0; i < c.volume->size(); ++i) print.add(c.volume->intensity(i));
    print.add(static_cast<double>(c.camera.projection));
    print.add(c.camera.eye);
    print.add(c.camera.center);
    print.add(c.clipping.lo);
    print.add(c.clipping.hi);
    for (const ClipPlane& plane : c.clipping.planes) {
        print.add(plane.normal);
        print.add(plane.offset);
    }
    for (const ControlPoint& p : c.tf.points) {
        print.add(p.x);
        print.add(p.opacity);
    }
    return print.value();
}

Grid<float> referenceField(const RandomCase& c) {
    char name[64];
    std::snprintf(name, sizeof name, "pellucid-accuracy-%016llx.f32",
                  static_cast<unsigned long long>(fingerprintOf(c)));
    const auto path = std::filesystem::temp_directory_path() / name;
    std::vector<float> values(c.volume->size());
    const auto bytes = static_cast<std::streamsize>(values.size() * sizeof(float));
    if (std::ifstream file(path, std::ios::binary); file.read(reinterpret_cast<char*>(values.data()), bytes))
        return {c.volume->dims(), std::move(values)};
    Grid<float> field = makeReferenceEngine(c.volume)->field(c.view(), c.tf).values;
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(field.data()), bytes);
    return field;
}

std::unique_ptr<VisibilityEngine> makeNamed(const std::string& name, const std::shared_ptr<const Volume>& volume) {
    const Quality quality = name.ends_with("-high") ? Quality::High : Quality::Normal;
    if (name.starts_with("slices")) return makeSlicesEngine(volume, quality);
    if (name.starts_with("gl")) return makeGlEngine(volume, quality);
    if (name.starts_with("cpu")) return makeCpuEngine(volume, quality);
    throw UsageError("there is no engine '" + name + "'", "accuracy", "name cpu, gl or slices, and -high");
}

void summary(const char* what, const std::vector<double>& values, double most, double median) {
    std::size_t worst = 0, beyond = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] > values[worst]) worst = i;
        if (values[i] > most) ++beyond;
    }
    std::printf("  %-4s max %.5f (allowed %.4f, %zu cases beyond)   median %.5f", what, values[worst], most, beyond,
                test::median(values));
    if (median > 0) std::printf(" (allowed %.4f)", median);
    std::printf("\n");
}

int run(std::uint32_t first, std::uint32_t last, const std::vector<std::string>& engines, const Variant& variant) {
    struct Figures {
        std::vector<double> rms, fv, w;
    };
    std::map<std::string, Figures> all;
    double referenceSeconds = 0;
    std::printf("%-9s %-105s %9s %8s %8s %8s\n", "engine", "case", "seen", "RMS", "dFV", "dW");
    for (std::uint32_t n = first; n < last; ++n) {
        const RandomCase c = randomCase(n, 1, variant);
        const auto start = std::chrono::steady_clock::now();
        const Grid<float> expected = referenceField(c);
        referenceSeconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        const WeightFields weights = saliencyFields(*c.volume, c.tf);
        const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
        const double largest = *std::max_element(expected.begin(), expected.end());
        const double seen = largest > 0 ? sum / largest : 0.0;
        for (const std::string& name : engines) {
            const Tolerances& allowed = name.ends_with("-high") ? kHighTolerances : kNormalTolerances;
            const Disagreement d = compareWithField(expected, *makeNamed(name, c.volume), c.view(), c.tf, weights);
            const bool beyond =
                d.visibilityRms > allowed.visibilityRms || std::max(d.visibility, d.vws) > allowed.figure;
            std::printf("%-9s %-105s %9.1f %8.5f %8.5f %8.5f%s\n", name.c_str(), c.describe().c_str(), seen,
                        d.visibilityRms, d.visibility, d.vws, beyond ? "  <<<" : "");
            std::fflush(stdout);
            all[name].rms.push_back(d.visibilityRms);
            all[name].fv.push_back(d.visibility);
            all[name].w.push_back(d.vws);
        }
    }
    for (const std::string& name : engines) {
        const Tolerances& allowed = name.ends_with("-high") ? kHighTolerances : kNormalTolerances;
        std::printf("%s, %zu cases\n", name.c_str(), all[name].rms.size());
        summary("RMS", all[name].rms, allowed.visibilityRms, 0);
        summary("FV", all[name].fv, allowed.figure, allowed.median);
        summary("W", all[name].w, allowed.figure, allowed.median);
    }
    std::printf("reference: %.1f s\n", referenceSeconds);
    return 0;
}

} // namespace

int main(int argc, char** argv) try {
    if (argc < 3) {
        std::fprintf(stderr,
                     "usage: accuracy FIRST LAST [affine] [clipped] [cpu|cpu-high|gl|gl-high|slices|slices-high …]\n");
        return 2;
    }
    std::vector<std::string> engines(argv + 3, argv + argc);
    const Variant variant{std::erase(engines, "affine") > 0, std::erase(engines, "clipped") > 0};
    if (engines.empty()) engines = {"cpu", "cpu-high"};
    const auto first = static_cast<std::uint32_t>(std::stoul(argv[1]));
    const auto last = static_cast<std::uint32_t>(std::stoul(argv[2]));
    return first < last ? run(first, last, engines, variant) : 2;
} catch (const std::exception& error) {
    std::fprintf(stderr, "accuracy: %s\n", error.what());
    return 1;
}
