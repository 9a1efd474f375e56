#include "ranks/rank_renderer.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>

#include "base/error.h"
#include "ranks/rank_volume.h"
#include "render/background.h"
#include "render/cpu/cpu_renderer.h"
#include "render/ground_raster.h"

namespace pellucid {

namespace {

/// Rows of pixels that one rank puts together. They take turns, so that all have some of what lies in the middle.
class Bands {
public:
    static constexpr int kRows = kTileRows;

    Bands(const Image& image, int ranks) : m_height(image.height), m_ranks(ranks) {}
    int count() const { return (m_height + kRows - 1) / kRows; }
    int begin(int band) const { return band * kRows; }
    int end(int band) const { return std::min(m_height, (band + 1) * kRows); }
    int rankOf(int band) const { return band % m_ranks; }

private:
    int m_height, m_ranks;
};

/// Gives all ranks the whole of a picture of which each has its own bands.
void shareBands(Communicator& ranks, const Bands& bands, Image& image) {
    const std::size_t perRow = 4 * static_cast<std::size_t>(image.width);
    const auto rows = [&](int band) {
        return std::span(image.rgba)
            .subspan(static_cast<std::size_t>(bands.begin(band)) * perRow,
                     static_cast<std::size_t>(bands.end(band) - bands.begin(band)) * perRow);
    };
    std::vector<std::byte> mine;
    for (int band = ranks.rank(); band < bands.count(); band += ranks.size())
        appendBytes(mine, std::span<const float>(rows(band)));
    const auto all = ranks.gather(mine);
    for (int r = 0; r < ranks.size(); ++r) {
        ByteReader reader(all[static_cast<std::size_t>(r)]);
        for (int band = r; band < bands.count(); band += ranks.size()) reader.take(rows(band));
    }
}

/// What stands before the pixels of a message: [x0, x1) × [y0, y1) of one band.
struct PieceHead {
    int band = 0;
    ImagePart at;
};

/// The smallest rectangle of a band that holds all of it that is not transparent.
ImagePart drawnPart(const Image& image, int begin, int end) {
    ImagePart part{image.width, end, 0, begin};
    for (int y = begin; y < end; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (image.pixel(x, y)[3] <= 0) continue;
            part = {std::min(part.x0, x), std::min(part.y0, y), std::max(part.x1, x + 1), y + 1};
        }
    return part;
}

/// Lays what a block has drawn, colours straight, under what `image` has, whose colours are premultiplied.
void layUnder(Image& image, const ImagePart& at, ByteReader& reader) {
    std::vector<float> row(4 * static_cast<std::size_t>(at.x1 - at.x0));
    for (int y = at.y0; y < at.y1; ++y) {
        reader.take(std::span(row));
        const float* from = row.data();
        for (int x = at.x0; x < at.x1; ++x, from += 4) {
            float* const to = image.pixel(x, y);
            const float seen = (1 - to[3]) * from[3];
            for (int c = 0; c < 3; ++c) to[c] += seen * from[c];
            to[3] += seen;
        }
    }
}

/// Puts the pictures of all blocks together: each band on its rank, in `order` from the eye on.
Image composited(Communicator& ranks, const std::vector<int>& order, const Image& mine) {
    const Bands bands(mine, ranks.size());
    std::vector<RankMessage> out(static_cast<std::size_t>(ranks.size()));
    for (int r = 0; r < ranks.size(); ++r) out[static_cast<std::size_t>(r)].rank = r;
    for (int band = 0; band < bands.count(); ++band) {
        const ImagePart part = drawnPart(mine, bands.begin(band), bands.end(band));
        if (part.x0 >= part.x1) continue;
        auto& bytes = out[static_cast<std::size_t>(bands.rankOf(band))].bytes;
        appendBytes(bytes, PieceHead{band, part});
        for (int y = part.y0; y < part.y1; ++y)
            appendBytes(bytes, std::span(mine.pixel(part.x0, y), 4 * static_cast<std::size_t>(part.x1 - part.x0)));
    }
    const std::vector<RankMessage> received = ranks.exchange(std::move(out));
    Image image(mine.width, mine.height);
    for (const int block : order)
        for (const RankMessage& message : received) {
            if (message.rank != block) continue;
            for (ByteReader reader(message.bytes); !reader.atEnd();) {
                const auto head = reader.take<PieceHead>();
                layUnder(image, head.at, reader);
            }
        }
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
        if (const float alpha = image.rgba[i + 3]; alpha > 0)
            for (std::size_t c = 0; c < 3; ++c) image.rgba[i + c] /= alpha;
    shareBands(ranks, bands, image);
    return image;
}

/// The block itself, as a part of the box around what is stored of it.
BoxPart partOf(const BlockVolume& block) {
    BoxPart part;
    const Vec3 stored(block.region.hi - block.region.lo);
    part.lo = Vec3(block.block().lo - block.region.lo) / stored;
    part.hi = Vec3(block.block().hi - block.region.lo) / stored;
    return part;
}

/// A part of the whole's box, for the box around what is stored of a block. Half-spaces are the world's.
BoxPart inBlock(const BoxPart& whole, const BlockVolume& block) {
    BoxPart here = whole;
    const Vec3 dims(block.whole.dims), stored(block.region.hi - block.region.lo), first(block.region.lo);
    here.lo = glm::max(Vec3(0), (whole.lo * dims - first) / stored);
    here.hi = glm::min(Vec3(1), (whole.hi * dims - first) / stored);
    for (int a = 0; a < 3; ++a)
        if (!(here.lo[a] < here.hi[a])) // nothing of it is here
            return {{0, 0, 0}, {1, 1, 1}, {{{1, 0, 0}, -std::numeric_limits<float>::max()}}};
    return here;
}
Clipping clippingOf(const Clipping& whole, const BlockVolume& block) {
    Clipping here;
    here.setPart(inBlock(whole.part(), block));
    here.rest = {inBlock(whole.rest.within, block), whole.rest.density};
    return here;
}

void refuseWhatBlocksCannot(const RenderSettings& settings) {
    const auto refuse = [](bool asked, const char* what, const char* option) {
        if (asked)
            throw UsageError(std::string("ranks draw no ") + what + " of a volume in blocks", option,
                             "leave it out, or use pellucid-cli");
    };
    refuse(settings.mode != RenderMode::Composite, "mode but composite", "--mode");
    refuse(settings.light.occlusion > 0, "ambient occlusion", "--occlusion");
    refuse(settings.colors != nullptr, "colours by voxel", "--hsb");
    refuse(showsGround(settings), "ground", "--ground");
    refuse(settings.overlay != nullptr, "overlay", "--overlay");
}

class BlockRenderer final : public ImageRenderer {
public:
    BlockRenderer(Communicator& ranks, BlockVolume block) : m_ranks(ranks), m_block(std::move(block)) {
        if (m_block.isEmpty()) return;
        CpuRenderOptions options;
        options.blockOf = m_block.whole;
        options.part = partOf(m_block);
        m_renderer = makeCpuRenderer(m_block.stored, options);
    }

    std::string name() const override { return "cpu"; }
    Image render(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                 const JobControl& job) override {
        settings.validate();
        refuseWhatBlocksCannot(settings);
        camera.validate(m_block.whole, "camera");
        settings.featureAlone(tf); // tells where there is none
        Image image(settings.width, settings.height);
        if (m_renderer) {
            RenderSettings mine = settings;
            mine.clipping = clippingOf(settings.clipping, m_block);
            image = m_renderer->render(camera, tf, mine, job);
        }
        const std::vector<int> order =
            camera.projection == Projection::Perspective
                ? m_block.blocks.orderFrom(m_block.whole.voxelFromWorld(camera.eye))
                : m_block.blocks.orderAlong(m_block.whole.indexFromWorld() * camera.forward());
        image = composited(m_ranks, order, image);
        paintBackground(image, settings);
        return image;
    }

private:
    Communicator& m_ranks;
    BlockVolume m_block;
    std::unique_ptr<ImageRenderer> m_renderer; ///< null where the rank has no block
};

/// Each rank draws its bands of the picture.
class SharedRenderer final : public ImageRenderer {
public:
    SharedRenderer(Communicator& ranks, std::shared_ptr<const Volume> volume) : m_ranks(ranks) {
        CpuRenderOptions options;
        options.bands = {ranks.rank(), ranks.size()};
        m_renderer = makeCpuRenderer(std::move(volume), options);
    }

    std::string name() const override { return m_renderer->name(); }
    Image render(const Camera& camera, const TransferFunction& tf, const RenderSettings& settings,
                 const JobControl& job) override {
        Image image = m_renderer->render(camera, tf, settings, job);
        shareBands(m_ranks, Bands(image, m_ranks.size()), image);
        return image;
    }

private:
    Communicator& m_ranks;
    std::unique_ptr<ImageRenderer> m_renderer;
};

} // namespace

std::unique_ptr<ImageRenderer> makeRendererOnRanks(Communicator& ranks, std::shared_ptr<const Volume> volume) {
    if (const auto* blocks = dynamic_cast<const RankVoxels*>(volume->elsewhere()))
        return std::make_unique<BlockRenderer>(blocks->ranks(), blocks->blockOf(*volume));
    return std::make_unique<SharedRenderer>(ranks, std::move(volume));
}

} // namespace pellucid
