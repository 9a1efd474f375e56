#include "ranks/depth_exchange.h"

#include <algorithm>
#include <tuple>

namespace pellucid {

namespace {

void append(std::vector<std::byte>& bytes, const RayDepths& depths, const DepthPartHead& head) {
    const std::size_t needed =
        bytes.size() + sizeof head + head.rect.rays() * static_cast<std::size_t>(depths.lanes) * sizeof(float);
    if (needed > bytes.capacity()) bytes.reserve(needed + needed / 4); // memory may be short
    appendBytes(bytes, head);
    const auto perRow =
        static_cast<std::size_t>(head.rect.endCol - head.rect.firstCol) * static_cast<std::size_t>(depths.lanes);
    for (int row = head.rect.firstRow; row < head.rect.endRow; ++row)
        appendBytes(bytes,
                    std::span(depths.values).subspan(depths.rect.at(head.rect.firstCol, row, depths.lanes), perRow));
}

/// Whether any ray of a part is handed over.
bool isHanded(const RayDepths& depths, const SweepRect& part) {
    for (int row = part.firstRow; row < part.endRow; ++row)
        for (int col = part.firstCol; col < part.endCol; ++col)
            if (depths.values[depths.rect.at(col, row, depths.lanes)] >= 0) return true;
    return false;
}

struct Part {
    DepthPartHead head;
    int from = 0;
    RayDepths depths;
};

/// The parts that a message holds.
void readParts(const RankMessage& message, int lanes, std::vector<Part>& parts) {
    for (ByteReader reader(message.bytes); !reader.atEnd();) {
        Part& part = parts.emplace_back();
        part.from = message.rank;
        part.head = reader.take<DepthPartHead>();
        part.depths = RayDepths(part.head.rect, lanes, 0);
        reader.take(std::span(part.depths.values));
    }
}

/// Calls body(ray of `into`, ray of `from`) for those that both have; each points to its lanes.
template <class Into, class From, class Body>
void forCommonRays(Into& into, From& from, const Body& body) {
    const SweepRect both = common(into.rect, from.rect);
    for (int row = both.firstRow; row < both.endRow; ++row)
        for (int col = both.firstCol; col < both.endCol; ++col)
            body(into.values.data() + into.rect.at(col, row, into.lanes),
                 from.values.data() + from.rect.at(col, row, from.lanes));
}

} // namespace

SweepRect DepthTiles::at(int tile) const {
    const int row = m_all.firstRow + tile / m_cols * kTile, col = m_all.firstCol + tile % m_cols * kTile;
    return common({row, row + kTile, col, col + kTile}, m_all);
}

int DepthTiles::perRound(int lanes) const {
    constexpr std::size_t kBytesAtOnce = 1u << 20; // of depths of the tiles that are under way, per rank
    const std::size_t ranks = static_cast<std::size_t>(m_ranks),
                      bytes = std::size_t{kTile} * kTile * static_cast<std::size_t>(lanes) * sizeof(float);
    return static_cast<int>(std::max(ranks, kBytesAtOnce * ranks / bytes));
}

void findDepthsBefore(Communicator& ranks, const std::vector<int>& order, const SweepRect& all, CarriedDepths carried,
                      RayDepths& before) {
    if (all.rays() == 0) return;
    const int lanes = before.lanes;
    const DepthTiles tiles(all, ranks.size());
    const auto count = static_cast<std::size_t>(ranks.size());
    const auto lanesOf = static_cast<std::size_t>(lanes);
    std::vector<std::size_t> placeOf(count); // in the order
    for (std::size_t i = 0; i < count; ++i) placeOf[static_cast<std::size_t>(order[i])] = i;
    const int atOnce = tiles.perRound(lanes);

    for (int first = 0; first < tiles.count(); first += atOnce) {
        const int end = std::min(tiles.count(), first + atOnce);
        std::vector<RankMessage> out(count);
        for (std::size_t r = 0; r < count; ++r) out[r].rank = static_cast<int>(r);
        for (int tile = first; tile < end; ++tile) {
            auto& bytes = out[static_cast<std::size_t>(tiles.rankOf(tile))].bytes;
            const SweepRect rect = tiles.at(tile);
            if (const SweepRect part = common(rect, carried.through.rect);
                part.rays() > 0 && carried.groups.any(part, RayGroups::kBehind))
                append(bytes, carried.through, {tile, -1, part});
            for (const HandedDepths& handed : carried.handed)
                if (const SweepRect part = common(rect, handed.depths.rect);
                    part.rays() > 0 && isHanded(handed.depths, part))
                    append(bytes, handed.depths, {tile, handed.to, part});
        }
        if (end == tiles.count()) carried = {}; // its memory is wanted
        std::vector<Part> parts;
        for (const RankMessage& message : ranks.exchange(std::move(out))) readParts(message, lanes, parts);

        // Of each tile the blocks in their order; what is handed over by a block comes before its whole way.
        std::ranges::stable_sort(parts, {}, [&](const Part& part) {
            return std::tuple(part.head.tile, placeOf[static_cast<std::size_t>(part.from)], part.head.to < 0);
        });
        std::vector<RankMessage> back(count);
        for (std::size_t r = 0; r < count; ++r) back[r].rank = static_cast<int>(r);
        RayDepths sum;
        int tile = -1;
        for (Part& part : parts) {
            if (part.head.tile != tile) {
                tile = part.head.tile;
                sum = RayDepths(tiles.at(tile), lanes, 0);
            }
            if (part.head.to < 0) {
                forCommonRays(sum, part.depths, [&](float* total, const float* more) {
                    for (std::size_t lane = 0; lane < lanesOf; ++lane) total[lane] += more[lane];
                });
                continue;
            }
            forCommonRays(part.depths, sum, [&](float* handed, const float* total) {
                if (handed[0] < 0) return;
                for (std::size_t lane = 0; lane < lanesOf; ++lane) handed[lane] += total[lane];
            });
            append(back[static_cast<std::size_t>(part.head.to)].bytes, part.depths, part.head);
        }
        parts.clear();
        std::vector<Part> mine;
        for (const RankMessage& message : ranks.exchange(std::move(back))) readParts(message, lanes, mine);
        for (const Part& part : mine)
            forCommonRays(before, part.depths, [&](float* here, const float* handed) {
                if (handed[0] < 0) return;
                for (std::size_t lane = 0; lane < lanesOf; ++lane) here[lane] = handed[lane];
            });
    }
}

} // namespace pellucid
