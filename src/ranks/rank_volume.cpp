#include "ranks/rank_volume.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>

#include "ranks/process_ranks.h"
#include "volume/excerpt.h"
#include "volume/file_contents.h"
#include "volume/volume_part.h"

namespace pellucid {

namespace {

/// What all ranks have to agree on.
struct OfAll {
    double lo = std::numeric_limits<double>::infinity(), hi = -std::numeric_limits<double>::infinity();
    std::uint64_t invalid = 0;
    Geometry whole;
};

std::uint64_t invalidIn(const BlockVolume& block) {
    if (block.isEmpty() || block.stored->invalidCount() == 0) return 0;
    std::uint64_t count = 0;
    const VolumePart part{block.stored.get(), block.region.lo, block.block()};
    part.forOwnRows(0, part.ownLayers(), [&](const Int3&, std::size_t row, int voxels) {
        for (std::size_t i = row; i < row + static_cast<std::size_t>(voxels); ++i) count += !block.stored->isValid(i);
    });
    return count;
}

/// What an error says, for other ranks.
std::string told(char kind, const Error& e) {
    return kind + std::to_string(static_cast<int>(e.remedy())) + "\n" + e.problem() + "\n" + e.where() + "\n" +
           e.whatToDo();
}
[[noreturn]] void throwTold(const std::string& text) {
    std::istringstream lines(text);
    std::string head, problem, where, whatToDo;
    for (std::string* part : {&head, &problem, &where, &whatToDo}) std::getline(lines, *part);
    const auto remedy = static_cast<Remedy>(std::stoi(head.substr(1)));
    if (head[0] == 'u') throw UsageError(problem, where, whatToDo, remedy);
    if (head[0] == 'f') throw FileError(problem, where, whatToDo, remedy);
    throw Error(problem, where, whatToDo, remedy);
}

/// What read() returns. Where a rank cannot read, all throw what the first of those has to say, so that they stay in
/// step when somebody passes over it.
template <class Read>
auto readTogether(Communicator& ranks, const Read& read) {
    std::optional<decltype(read())> result;
    std::string failure;
    try {
        result.emplace(read());
    } catch (const UsageError& e) {
        failure = told('u', e);
    } catch (const FileError& e) {
        failure = told('f', e);
    } catch (const Error& e) {
        failure = told('e', e);
    }
    for (const auto& text : ranks.gather(std::as_bytes(std::span(failure))))
        if (!text.empty()) throwTold({reinterpret_cast<const char*>(text.data()), text.size()});
    return std::move(*result);
}

/// The geometry of all data, of which `volume` has the voxels from `first` on.
Geometry wholeOf(const Volume& volume, const Int3& dims, const Int3& first) {
    Geometry whole = volume.geometry();
    whole.origin = whole.worldFromVoxel(-Vec3(first));
    whole.dims = dims;
    whole.referenceLength = whole.d0();
    return whole;
}

} // namespace

BlockVolume RankVoxels::blockOf(const Volume& volume) const {
    BlockVolume block = m_block;
    block.stored = volume.here();
    return block;
}

Decomposition RankLayout::blocksOf(const Int3& dims, int ranks) const {
    return cut && cut->dims() == dims ? *cut : Decomposition(dims, ranks);
}

bool RankLayout::isWhole(const Int3& dims, SampleType type, const MemoryUse& then, int ranks) const {
    if (ranks == 1 || voxelCount(dims) < smallest) return true;
    return dividesFrames() && bytesOf(then, dims, type) + 4 * voxelCount(dims) * bytesPerSample(type) <= roomForFrame;
}

Volume volumeOfBlocks(Communicator& ranks, BlockVolume block, const Volume& like, RankLayout* layout) {
    OfAll mine;
    mine.whole = block.whole;
    if (!block.isEmpty() && block.stored->hasValidVoxels()) {
        mine.lo = block.stored->dataRange().lo;
        mine.hi = block.stored->dataRange().hi;
    }
    mine.invalid = invalidIn(block);
    Volume::Distributed parts;
    const auto all = gatherValues(ranks, mine);
    ValueRange range{all[0].lo, all[0].hi};
    for (const OfAll& other : all) {
        range.lo = std::min(range.lo, other.lo);
        range.hi = std::max(range.hi, other.hi);
        parts.invalidCount += other.invalid;
    }
    if (!(range.lo <= range.hi)) range = {0, 0};
    block.whole = all[0].whole; // the same bits for all
    parts.type = like.sampleType();
    parts.dataRange = range;
    parts.missing = like.missing();
    if (!block.isEmpty())
        parts.here =
            range.lo < range.hi ? std::make_shared<const Volume>(block.stored->withRange(range)) : block.stored;
    block.stored.reset();
    const Geometry whole = block.whole;
    parts.elsewhere = std::make_shared<const RankVoxels>(ranks, std::move(block), layout);
    Volume volume(whole, std::move(parts));
    volume.title = like.title;
    volume.format = like.format;
    volume.notices = like.notices;
    return volume;
}

Volume loadOnRanks(Communicator& ranks, const VolumeSource& source, RankLayout& layout, const JobControl& job) {
    const Int3 ghosts(std::max(kRayGhosts, source.then.reach));
    if (source.isSample()) {
        // Made by a rule: each rank makes all of it, and keeps its block.
        Volume all = loadHere(source, job);
        if (layout.isWhole(all.dims(), all.sampleType(), source.then, ranks.size())) return all;
        const auto whole = std::make_shared<const Volume>(std::move(all));
        const Decomposition blocks = layout.blocksOf(whole->dims(), ranks.size());
        return volumeOfBlocks(ranks, blockOf(whole, blocks, ranks.rank(), ghosts), *whole, &layout);
    }
    const FileContents contents = readTogether(ranks, [&] { return contentsOf(source, job); });
    const VoxelRegion all = source.region.value_or(VoxelRegion{Int3(0), contents.dims});
    const Int3 dims = all.hi - all.lo;
    if (isEmpty(all) || layout.isWhole(dims, contents.type, source.then, ranks.size()))
        return readTogether(ranks, [&] { return loadHere(source, job); });
    if (source.downsample > 1)
        throw UsageError("ranks read data as they are", "--downsample", "leave it out, or use pellucid-cli");

    BlockVolume block;
    block.blocks = layout.blocksOf(dims, ranks.size());
    block.own = ranks.rank();
    block.region = widened(block.block(), ghosts, dims);
    VolumeSource part = source;
    part.downsample = 1;
    part.range.reset();
    part.then = {}; // how much its block takes is known when it is there
    // A rank without a block reads a voxel, for what else there is to know.
    const bool none = isEmpty(block.region);
    const VoxelRegion read = none ? VoxelRegion{Int3(0), Int3(1)} : block.region;
    part.region = VoxelRegion{all.lo + read.lo, all.lo + read.hi};
    Volume volume = readTogether(ranks, [&] { return loadHere(part, job); });
    block.whole = wholeOf(volume, dims, read.lo);
    // That it is a part is no news here.
    const std::vector<std::string> ofBlock = planOf(*part.region, contents.dims, 1).notices();
    std::erase_if(volume.notices, [&](const std::string& notice) { return std::ranges::count(ofBlock, notice) > 0; });
    const auto stored = std::make_shared<const Volume>(std::move(volume));
    if (!none) block.stored = stored;
    Volume result = volumeOfBlocks(ranks, std::move(block), *stored, &layout);
    if (source.region) {
        const ExcerptPlan plan = planOf(all, contents.dims, 1);
        result.excerpt = plan.excerpt;
        const auto said = plan.notices();
        result.notices.insert(result.notices.begin(), said.begin(), said.end());
    }
    if (source.range) result = result.withRange(*source.range);
    return result;
}

} // namespace pellucid
