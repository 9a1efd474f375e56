// Quick pictures of Pellucid's cpu renderer against those of VolPack (Lacroute's shear-warp library of 1994), on one
// thread: the same volume, opacities, parallel views and size, the two programs in turn, processor time. See README.md
// here; built where libvolpack1-dev is installed.
//
// VolPack draws one grey channel of 8 bits from a volume that has been classified for the transfer function, which is
// timed apart; Pellucid draws four channels from the intensities themselves.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numeric>
#include <stdexcept>
#include <string>

#include <volpack.h>

#include "base/parallel.h"
#include "render/cpu/cpu_renderer.h"
#include "render/ssim.h"
#include "tf/transfer_function.h"
#include "volume/loader.h"

using namespace pellucid;

namespace {

constexpr double kElevation = 20;                          ///< degrees, of the orbit
constexpr double kLeastOpacity = 0.5 / 255, kDark = 0.999; ///< what VolPack leaves out, and where its rays end
constexpr int kPictureSize = 512;

double cpuSeconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// What a call to VolPack gave: it keeps the error in the context.
void require(vpContext* context, vpResult result) {
    if (result != VP_OK) throw std::runtime_error(vpGetErrorString(vpGetError(context)));
}

class VolPack {
public:
    /// What its shader looks up has 16 bits, what is classified 8.
    struct Voxel {
        unsigned short shade = 0;
        unsigned char scalar = 0;
    };

    explicit VolPack(const Volume& volume) : m_context(vpCreateContext()), m_voxels(volume.size()) {
        const Int3 n = volume.dims();
        for (std::size_t i = 0; i < volume.size(); ++i) {
            m_voxels[i].scalar = static_cast<unsigned char>(volume.intensity(i) * 255 + 0.5);
            m_voxels[i].shade = m_voxels[i].scalar;
        }
        require(m_context, vpSetVolumeSize(m_context, n.x, n.y, n.z));
        require(m_context, vpSetVoxelSize(m_context, sizeof(Voxel), 2, 1, 1));
        require(m_context, vpSetVoxelField(m_context, 0, sizeof(unsigned short), offsetof(Voxel, shade), 255));
        require(m_context, vpSetVoxelField(m_context, 1, sizeof(unsigned char), offsetof(Voxel, scalar), 255));
        constexpr int kStride = sizeof(Voxel);
        require(m_context, vpSetRawVoxels(m_context, m_voxels.data(), static_cast<int>(m_voxels.size() * sizeof(Voxel)),
                                          kStride, kStride * n.x, kStride * n.x * n.y));
        std::iota(m_grey.begin(), m_grey.end(), 0.0f);
        require(m_context, vpSetLookupShader(m_context, 1, 1, 0, m_grey.data(), sizeof m_grey, 0, nullptr, 0));
        require(m_context, vpSetd(m_context, VP_MAX_RAY_OPACITY, kDark));
        require(m_context, vpSetd(m_context, VP_MIN_VOXEL_OPACITY, kLeastOpacity));
        require(m_context,
                vpSetImage(m_context, m_image.data(), kPictureSize, kPictureSize, kPictureSize, VP_LUMINANCE));
        const Geometry& g = volume.geometry();
        m_size = Vec3(n) * g.spacing;
        vpWindow(m_context, VP_PARALLEL, -g.radius(), g.radius(), -g.radius(), g.radius(), -2 * g.radius(),
                 2 * g.radius());
    }
    ~VolPack() { vpDestroyContext(m_context); }
    VolPack(const VolPack&) = delete;
    VolPack& operator=(const VolPack&) = delete;

    void classify(const TransferFunction& tf) {
        const TfSampler sampler(tf);
        for (std::size_t i = 0; i < m_opacity.size(); ++i)
            m_opacity[i] = static_cast<float>(sampler.opacity(static_cast<double>(i) / 255));
        require(m_context, vpSetClassifierTable(m_context, 0, 1, m_opacity.data(), sizeof m_opacity));
        require(m_context, vpClassifyVolume(m_context));
    }

    void draw(double azimuth) {
        vpCurrentMatrix(m_context, VP_MODEL);
        vpIdentityMatrix(m_context);
        vpRotate(m_context, VP_X_AXIS, kElevation - 90);
        vpRotate(m_context, VP_Z_AXIS, -azimuth);
        vpScale(m_context, m_size.x, m_size.y, m_size.z);
        require(m_context, vpRenderClassifiedVolume(m_context));
    }

    void write(const std::string& path) const {
        std::FILE* file = std::fopen(path.c_str(), "wb");
        if (!file) throw std::runtime_error("cannot write " + path);
        std::fprintf(file, "P5\n%d %d\n255\n", kPictureSize, kPictureSize);
        for (int y = kPictureSize; y-- > 0;) // VolPack's pictures begin at the bottom
            std::fwrite(&m_image[static_cast<std::size_t>(y * kPictureSize)], 1, kPictureSize, file);
        std::fclose(file);
    }

private:
    vpContext* m_context;
    std::vector<Voxel> m_voxels;
    std::vector<unsigned char> m_image = std::vector<unsigned char>(kPictureSize * kPictureSize);
    std::array<float, 256> m_grey{}, m_opacity{};
    Vec3 m_size{};
};

struct Times {
    std::vector<double> volpack, quick, full;
    double least = 1; ///< SSIM of the quick picture to the full one
};

/// All views by each program in turn.
void measure(VolPack& volpack, TileRenderer& renderer, const Geometry& geometry, const TransferFunction& tf, int views,
             Times& times) {
    RenderSettings settings;
    settings.width = settings.height = kPictureSize;
    settings.stepInD0 = 1;
    for (int i = 0; i < views; ++i) {
        const double azimuth = 360.0 * i / views;
        const Camera camera = cameraFromView(geometry, azimuth, kElevation, 1, Projection::Orthographic);
        const double start = cpuSeconds();
        volpack.draw(azimuth);
        const double drawn = cpuSeconds();
        const Image quick = renderer.preview(camera, tf, settings, 1);
        const double quickDrawn = cpuSeconds();
        const Image full = renderer.render(camera, tf, settings);
        times.volpack.push_back(drawn - start);
        times.quick.push_back(quickDrawn - drawn);
        times.full.push_back(cpuSeconds() - quickDrawn);
        times.least = std::min(times.least, ssim(quick, full));
    }
}

void compare(const std::string& path, int views, int rounds, const char* picture) {
    VolumeSource source;
    source.path = path;
    const auto volume = std::make_shared<const Volume>(loadVolume(source));
    const auto renderer = makeCpuRenderer(volume);
    VolPack volpack(*volume);
    std::printf("%s %s, %d^2 pixels, 1 thread, medians of %d x %d parallel views, CPU time [ms]\n"
                "  peak   VolPack   quick   ratio    rays   SSIM of quick   VolPack's classification\n",
                path.c_str(), dimsText(volume->dims()).c_str(), kPictureSize, rounds, views);
    for (const double peak : {0.5, 0.1, 0.02}) {
        const TransferFunction tf = tents(3, peak);
        const double start = cpuSeconds();
        volpack.classify(tf);
        const double classified = cpuSeconds() - start;
        Times warm, times;
        measure(volpack, *renderer, volume->geometry(), tf, std::min(views, 8), warm); // tables and turned copies
        for (int round = 0; round < rounds; ++round) measure(volpack, *renderer, volume->geometry(), tf, views, times);
        const double theirs = median(times.volpack), ours = median(times.quick);
        std::printf("  %4g   %7.1f %7.1f %7.2f %7.1f   %13.3f   %24.0f\n", peak, 1e3 * theirs, 1e3 * ours,
                    ours / theirs, 1e3 * median(times.full), times.least, 1e3 * classified);
        std::fflush(stdout);
        if (picture) volpack.write(std::string(picture) + "_" + std::to_string(peak).substr(0, 4) + ".pgm");
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 5) {
        std::fprintf(stderr, "usage: volpack_comparison VOLUME [VIEWS [ROUNDS [PICTURE]]]\n");
        return 2;
    }
    try {
        setThreadCount(1);
        compare(argv[1], argc > 2 ? std::atoi(argv[2]) : 24, argc > 3 ? std::atoi(argv[3]) : 3,
                argc > 4 ? argv[4] : nullptr);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
