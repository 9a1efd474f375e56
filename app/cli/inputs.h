// The options that commands share ("Input" in the manual): which volume, which transfer function, from where, by what.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "progress.h"
#include "render/camera.h"
#include "engines/engines.h"
#include "render/memory_needs.h"
#include "render/visibility.h"
#include "saliency/saliency_field.h"
#include "saliency/vws.h"
#include "tf/transfer_function.h"
#include "volume/loader.h"

namespace pellucid::cli {

/// VOLUME, --raw, --spacing, --skip, --missing, --range, --component, --sample-size, --seed.
struct VolumeOptions {
    std::string path;
    std::optional<RawLayout> raw;
    std::optional<Vec3> spacing;
    std::optional<std::uint64_t> skipBytes;
    std::optional<double> missing;
    std::optional<ValueRange> range;
    int component = 0;
    std::optional<int> sampleSize;
    std::uint32_t seed = 1;

    /// --size is a second name of --sample-size, except in commands whose --size is an image's.
    enum class SizeIs { Sample, Image };
    void add(CLI::App& app, SizeIs size = SizeIs::Sample);
    /// Throws UsageError for options that do not go together.
    /// `then` tells what memory is needed for beside the volume.
    VolumeSource source(const MemoryUse& then = {}) const;
};

/// Reads the volume as the options say.
std::shared_ptr<const Volume> loadVolume(const VolumeOptions& options, Progress& progress, const MemoryUse& then = {});

/// --tf.
struct TfOptions {
    std::optional<std::string> spec;
    void add(CLI::App& app);
};

struct VolumeAndTf {
    std::shared_ptr<const Volume> volume;
    TransferFunction tf; ///< its range is the volume's window
};

/// The volume and the transfer function, which agree on the intensity window: --range, else the file's range, else
/// the volume's own.
VolumeAndTf loadVolumeAndTf(const VolumeOptions& volume, const TfOptions& tf, Progress& progress,
                            const MemoryUse& then = {});

/// --camera, --view, --orthographic.
struct CameraOptions {
    std::optional<std::string> file;
    struct View {
        double azimuth = 30, elevation = 20, zoom = 1;
    };
    std::optional<View> view;
    bool orthographic = false;

    void add(CLI::App& app);
    /// The camera, outside the box of the volume; throws where it is not.
    Camera camera(const Geometry& geometry) const;
    /// Throws UsageError for options that do not go together, Error where the file cannot be read. Needs no volume.
    void check() const;
};

/// --engine, --quality.
struct EngineOptions {
    EngineChoice choice = EngineChoice::Auto;
    Quality quality = Quality::Normal;
    void add(CLI::App& app, const std::string& qualityHelp);
    /// What `doing` ("measuring") takes that takes `bytesPerVoxel` with the cpu engine.
    MemoryUse memoryFor(const std::string& doing, double bytesPerVoxel) const;
};

/// --sigma, --kernel, --w1, --w2, --u1, --u2, --saliency-background.
struct SaliencyInput {
    SaliencyOptions saliency;
    std::optional<double> u1, u2;

    void add(CLI::App& app);
    VwsOptions vws() const; ///< throws UsageError unless the weights sum to 1; one alone determines the other
};

} // namespace pellucid::cli
