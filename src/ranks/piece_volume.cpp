#include "ranks/piece_volume.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "ranks/piece_exchange.h"
#include "volume/volume_part.h"

namespace pellucid {

namespace {

template <class T>
Samples samplesAs(std::span<const std::byte> bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return SampleArray<T>(std::move(values));
}

Samples samplesOf(SampleType type, std::span<const std::byte> bytes) {
    switch (type) {
    case SampleType::U8:
        return samplesAs<std::uint8_t>(bytes);
    case SampleType::I8:
        return samplesAs<std::int8_t>(bytes);
    case SampleType::U16:
        return samplesAs<std::uint16_t>(bytes);
    case SampleType::I16:
        return samplesAs<std::int16_t>(bytes);
    case SampleType::U32:
        return samplesAs<std::uint32_t>(bytes);
    case SampleType::I32:
        return samplesAs<std::int32_t>(bytes);
    case SampleType::F32:
        return samplesAs<float>(bytes);
    case SampleType::F64:
        return samplesAs<double>(bytes);
    }
    PELLUCID_CHECK(false);
    return {};
}

Geometry partOf(const Geometry& whole, const VoxelRegion& region) {
    Geometry part = whole;
    part.origin = whole.worldFromVoxel(Vec3(region.lo));
    part.dims = region.hi - region.lo;
    return part;
}

} // namespace

std::shared_ptr<const Volume> volumeOfPieces(Communicator& ranks, const VolumePiece& piece, int reach,
                                             const RankLayout& layout) {
    struct Known {
        Geometry whole;
        SampleType type;
        bool has;
    };
    const auto all = gatherValues(ranks, Known{piece.whole, piece.type, !isEmpty(piece.region)});
    const auto first = std::ranges::find(all, true, &Known::has);
    if (first == all.end()) throw Error("the volume has no voxels", "the volume", "give one that has some");
    for (const Known& other : all)
        if (other.has && (other.type != first->type || other.whole.dims != first->whole.dims))
            throw Error("its pieces have values of different types, or other extents", "the volume",
                        "give pieces of one volume");
    Geometry whole = first->whole;
    whole.referenceLength = whole.d0();
    const SampleType type = first->type;
    const std::size_t bytesEach = bytesPerSample(type);

    if (ranks.size() == 1 || voxelCount(whole.dims) < layout.smallest) {
        const VoxelRegion everything{Int3(0), whole.dims};
        return std::make_shared<const Volume>(
            whole, samplesOf(type, exchangeVoxels(ranks, piece.region, piece.samples, everything, bytesEach)));
    }
    BlockVolume block;
    block.whole = whole;
    block.blocks = Decomposition(whole.dims, ranks.size());
    block.own = ranks.rank();
    block.region = widened(block.block(), Int3(std::max(kRayGhosts, reach)), whole.dims);
    const auto bytes = exchangeVoxels(ranks, piece.region, piece.samples, block.region, bytesEach);
    if (!isEmpty(block.region))
        block.stored = std::make_shared<const Volume>(partOf(whole, block.region), samplesOf(type, bytes));
    // A rank without voxels knows the type all the same.
    const Volume like =
        block.stored ? *block.stored
                     : Volume(partOf(whole, {Int3(0), Int3(1)}), samplesOf(type, std::vector<std::byte>(bytesEach)));
    return std::make_shared<const Volume>(volumeOfBlocks(ranks, std::move(block), like));
}

std::vector<float> valuesOnPiece(Communicator& ranks, const Volume& volume, const Grid<float>& field,
                                 const VoxelRegion& piece) {
    PELLUCID_CHECK(field.dims() == volume.dimsHere());
    VolumePart part = partHere(volume);
    const bool isWhole = volume.elsewhere() == nullptr; // then nobody has to be asked
    if (isWhole) part.own = piece;
    std::vector<float> own;
    if (part.volume != nullptr && !isEmpty(part.own))
        part.forOwnRows(0, part.ownLayers(), [&](const Int3&, std::size_t index, int voxels) {
            own.insert(own.end(), &field[index], &field[index] + voxels);
        });
    if (isWhole) return own;
    const VoxelRegion from = part.volume != nullptr ? part.own : VoxelRegion{};
    const auto bytes = exchangeVoxels(ranks, from, std::as_bytes(std::span(own)), piece, sizeof(float));
    std::vector<float> values(bytes.size() / sizeof(float));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

} // namespace pellucid
