#include "image_on_ranks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <thread>

#include <nlohmann/json.hpp>

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMPI.h>
#include <vtkMPICommunicator.h>
#include <vtkMatrix3x3.h>
#include <vtkMultiProcessController.h>

#include "base/parallel.h"
#include "base/text.h"
#include "optimize/answer/first_sight.h"
#include "optimize/fields.h"
#include "optimize/objective.h"
#include "optimize/views/opening_view.h"
#include "ranks/mpi/mpi_communicator.h"
#include "ranks/process_ranks.h"
#include "saliency/saliency_field.h"
#include "session/workspace.h"
#include "tf/formats/paraview_preset.h"
#include "tf/formats/tf_file.h"
#include "tf/proposal.h"
#include "tf/shown_tf.h"
#include "tf/tf_range.h"
#include "volume/volume_part.h"

namespace pellucid::paraview {

namespace {

/// A process that MPI has not started.
class AloneRank final : public Communicator {
public:
    int rank() const override { return 0; }
    int size() const override { return 1; }
    void await(const Work&) override {}
    std::vector<RankMessage> exchange(std::vector<RankMessage> messages) override {
        std::erase_if(messages, [](const RankMessage& m) { return m.bytes.empty(); });
        return messages;
    }
    void sum(std::span<double>) override {}
    std::vector<std::vector<std::byte>> gather(std::span<const std::byte> bytes) override {
        return {{bytes.begin(), bytes.end()}};
    }
};

/// While it is there the engines work on these ranks.
class WorkingOn {
public:
    explicit WorkingOn(Communicator& ranks) { setRanksOfProcess(&ranks); }
    ~WorkingOn() { setRanksOfProcess(nullptr); }
    WorkingOn(const WorkingOn&) = delete;
    WorkingOn& operator=(const WorkingOn&) = delete;
};

MpiRanks::Ending endingOf(Communicator& ranks, const std::function<void(Communicator&)>& work) {
    try {
        const WorkingOn working(ranks);
        work(ranks);
        return {};
    } catch (const RankLost&) {
        return {1, {}};
    } catch (const std::bad_alloc&) {
        return {1, "out of memory, use more processes or machines with more"};
    } catch (const std::exception& e) {
        return {1, e.what()};
    }
}

std::string nameOf(vtkDataArray& values) {
    const char* const name = values.GetName();
    return name != nullptr ? name : "the values";
}

SampleType typeOf(vtkDataArray& values) {
    switch (values.GetDataType()) {
    case VTK_UNSIGNED_CHAR:
        return SampleType::U8;
    case VTK_CHAR: // as the compilers that ParaView is built with have it
    case VTK_SIGNED_CHAR:
        return SampleType::I8;
    case VTK_UNSIGNED_SHORT:
        return SampleType::U16;
    case VTK_SHORT:
        return SampleType::I16;
    case VTK_UNSIGNED_INT:
        return SampleType::U32;
    case VTK_INT:
        return SampleType::I32;
    case VTK_FLOAT:
        return SampleType::F32;
    case VTK_DOUBLE:
        return SampleType::F64;
    default:
        throw Error("values of this type cannot be measured", nameOf(values),
                    "convert them with the filter Calculator");
    }
}

Geometry geometryOf(vtkImageData& image) {
    Geometry geometry;
    vtkMatrix3x3* const directions = image.GetDirectionMatrix();
    for (int a = 0; a < 3; ++a) {
        geometry.spacing[a] = image.GetSpacing()[a];
        geometry.origin[a] = image.GetOrigin()[a];
        for (int row = 0; row < 3; ++row) geometry.directions[a][row] = directions->GetElement(row, a);
    }
    return geometry;
}

Vec3 vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

Camera cameraOf(const Asked& asked, const Geometry& geometry) {
    const Projection projection = asked.parallel ? Projection::Orthographic : Projection::Perspective;
    if (asked.byDirection) return cameraFromView(geometry, asked.azimuth, asked.elevation, 1, projection);
    Camera camera;
    camera.projection = projection;
    camera.eye = vector(asked.position);
    camera.center = vector(asked.focalPoint);
    camera.up = vector(asked.viewUp);
    camera.fovY = asked.viewAngle;
    camera.height = 2 * asked.parallelScale;
    return camera;
}

} // namespace

std::string runOnRanks(int threads, const std::function<void(Communicator&)>& work) {
    vtkMultiProcessController* const controller = vtkMultiProcessController::GetGlobalController();
    auto* const mpi = controller != nullptr ? vtkMPICommunicator::SafeDownCast(controller->GetCommunicator()) : nullptr;
    if (mpi == nullptr || mpi->GetMPIComm() == nullptr || mpi->GetMPIComm()->GetHandle() == nullptr) {
        setThreadCount(threads);
        AloneRank alone;
        return endingOf(alone, work).message;
    }
    std::optional<MpiRanks> ranks;
    try {
        ranks.emplace(mpi->GetMPIComm()->GetHandle());
    } catch (const Error& e) {
        return e.what();
    }
    const MpiRanks::Ending ending = ranks->leave(endingOf(*ranks, [&](Communicator& all) {
        const int cores = static_cast<int>(std::thread::hardware_concurrency());
        setThreadCount(threads > 0 ? threads : std::max(1, cores / ranks->onThisMachine()));
        work(all);
    }));
    if (ending.status == 0) return {};
    return ending.message.empty() ? "another process cannot go on" : ending.message;
}

ImagePiece::ImagePiece(vtkImageData* image, vtkDataArray* values) {
    if (image == nullptr || image->GetNumberOfPoints() == 0) return;
    if (values == nullptr)
        throw Error("the image has no such values at its points", "Input Array",
                    "choose another, or apply the filter Cell Data to Point Data first");
    if (values->GetNumberOfComponents() != 1)
        throw Error("the values have several components", nameOf(*values),
                    "choose an array with one, or take one out with the filter Calculator");
    if (values->GetNumberOfTuples() != image->GetNumberOfPoints())
        throw Error("the values belong to cells", nameOf(*values), "apply the filter Cell Data to Point Data first");
    piece.type = typeOf(*values);
    piece.whole = geometryOf(*image);
    const int* const extent = image->GetExtent();
    for (int a = 0; a < 3; ++a) {
        piece.region.lo[a] = extent[2 * a];
        piece.region.hi[a] = extent[2 * a + 1] + 1;
    }
    const auto bytes = static_cast<std::size_t>(values->GetNumberOfTuples()) * bytesPerSample(piece.type);
    piece.samples = {static_cast<const std::byte*>(values->GetVoidPointer(0)), bytes};
}

Prepared prepared(Communicator& ranks, const ImagePiece& image, const Asked& asked) {
    // Extents of images count from anywhere; all pieces together are the whole.
    struct Ends {
        Int3 lo, hi;
        bool has;
    };
    VolumePiece piece = image.piece;
    Ends whole{Int3(0), Int3(0), false};
    for (const Ends& part : gatherValues(ranks, Ends{piece.region.lo, piece.region.hi, !isEmpty(piece.region)})) {
        if (!part.has) continue;
        whole = whole.has ? Ends{min(whole.lo, part.lo), max(whole.hi, part.hi), true} : part;
    }
    if (!whole.has) throw Error("the image has no points", "the input", "give one that has some");
    piece.whole.origin = piece.whole.worldFromVoxel(Vec3(whole.lo));
    piece.whole.dims = whole.hi - whole.lo;
    if (!isEmpty(piece.region)) {
        piece.region.lo -= whole.lo;
        piece.region.hi -= whole.lo;
    }
    MeasureInput input;
    const int reach = static_cast<int>(std::ceil(2 * input.settings.saliency.sigma));
    input.volume = volumeOfPieces(ranks, piece, reach);

    const bool proposes = asked.transferFunction.empty() || asked.transferFunction == "auto";
    std::optional<Proposal> proposal;
    if (proposes) {
        proposal = propose(*input.volume);
        input.tf = proposal->tf;
    } else {
        input.tf = loadTf(asked.transferFunction);
    }
    if (input.tf.range && *input.tf.range != input.volume->range())
        input.volume = std::make_shared<const Volume>(input.volume->withRange(*input.tf.range));
    input.view = View(cameraOf(asked, input.volume->geometry()));
    if (proposal) input.tf = withOpacitiesForView(*input.volume, *proposal, input.tf, input.view).tf;
    return {std::move(input), piece.region};
}

Seen seenOf(Communicator& ranks, const Prepared& prepared) {
    const MeasureInput& input = prepared.input;
    Workspace workspace;
    const Measures measures = workspace.measure(input);
    const WeightFields& weights = workspace.weights(input);
    const VoxelsElsewhere* const elsewhere = input.volume->elsewhere();
    const Grid<float> visibility = workspace.engine(input).field(input.view, input.tf).values;
    Grid<float> vws = visibility;
    visibilityToVws(vws, weights, input.settings.vws, {}, elsewhere);
    Seen seen;
    const auto add = [&](const std::string& name, const Grid<float>& field) {
        seen.fields.push_back({name, valuesOnPiece(ranks, *input.volume, field, prepared.piece)});
    };
    add("visibility", visibility);
    add("saliency", saliencyGrid(weights, FieldKind::Saliency, input.settings.vws, {}, elsewhere));
    add("vws", vws);
    for (std::size_t f = 0; f < input.tf.features.size(); ++f) {
        const std::string& name = input.tf.features[f].name;
        Grid<float> own = vws;
        keepFeature(own, *input.volume, input.tf, static_cast<int>(f));
        add("vws_" + name, own);
        seen.features.push_back(name);
        seen.visibility.push_back(measures.features[f].visibility);
        seen.vws.push_back(measures.features[f].vws);
    }
    return seen;
}

Answer optimized(Communicator& ranks, const Prepared& prepared, const std::string& targets, const std::string& file) {
    const MeasureInput& input = prepared.input;
    const std::size_t count = input.tf.features.size();
    std::vector<double> shares;
    if (targets == "equal") {
        shares.assign(count, 1.0);
    } else {
        std::istringstream words(targets);
        for (std::string word; std::getline(words, word, ',');) {
            double value = 0;
            if (!parseNumber(word, value)) throw Error("'" + word + "' is no number", "Targets", "give 1,2,2 or equal");
            shares.push_back(value);
        }
    }
    Workspace workspace;
    const OptimizeResult result = workspace.optimize(input, normalizedTargets(shares, count), {}, {});
    const OptimizeState &before = result.history.front(), &after = result.history[result.best];
    const TransferFunction tf = withShownOpacities(input.tf, after.opacity);
    const Volume& volume = *input.volume;
    if (!file.empty() && ranks.rank() == 0)
        writeTfFile({tf, volume.range(), volume.geometry(), presetNameOf(file), volume.dataRange()}, file);
    Answer answer;
    answer.preset = paraViewPreset(tf, volume.range(), "Pellucid").dump();
    answer.unitDistance = volume.geometry().d0();
    if (ranks.rank() != 0) return answer;
    for (const Feature& feature : input.tf.features) answer.features.push_back(feature.name);
    answer.targets = result.targets;
    answer.vwsBefore = before.vws;
    answer.vwsAfter = after.vws;
    answer.opacityBefore = before.opacity;
    answer.opacityAfter = after.opacity;
    return answer;
}

} // namespace pellucid::paraview
