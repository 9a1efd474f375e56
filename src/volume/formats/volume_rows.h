// The rows of a volume, of which a region is read.
#pragma once

#include "volume/formats/stored_values.h"

namespace pellucid {

/// Hands out the values of voxels that follow each other at one stride, in the order of the file.
template <class T>
class VoxelReader {
public:
    VoxelReader(Values& values, std::uint64_t stride)
        // Voxels lie close together: read what is between them, too. Far apart: pass over it.
        : m_values(values), m_stride(stride),
          m_pieceVoxels(stride <= 4096 ? std::max<std::uint64_t>(1, kPieceBytes / (stride * sizeof(T))) : 1) {}

    /// Calls body(values, voxels) for pieces of the `length` voxels from the file's value `start` on; values of voxels
    /// are a stride apart.
    template <class Body>
    void readLine(std::uint64_t start, std::uint64_t length, const Body& body) {
        for (std::uint64_t i = 0; i < length;) {
            m_values.skip(start + i * m_stride - m_at);
            const std::uint64_t voxels = std::min(m_pieceVoxels, length - i);
            const std::uint64_t span = (voxels - 1) * m_stride + 1;
            m_piece.resize(static_cast<std::size_t>(span));
            m_values.read(reinterpret_cast<char*>(m_piece.data()), m_piece.size());
            body(m_piece.data(), voxels);
            m_at = start + i * m_stride + span;
            i += voxels;
        }
    }

    /// The same of voxels that lie beside each other, straight to `to`.
    void readTo(T* to, std::uint64_t start, std::uint64_t length) {
        m_values.skip(start - m_at);
        m_values.read(reinterpret_cast<char*>(to), static_cast<std::size_t>(length));
        m_at = start + length;
    }

private:
    static constexpr std::uint64_t kPieceBytes = 4u << 20;
    Values& m_values;
    std::uint64_t m_stride, m_pieceVoxels;
    std::vector<T> m_piece;
    std::uint64_t m_at = 0; ///< the next value of the file
};

/// Rows of a volume, which are asked for in the order of the file.
template <class T>
class Rows {
public:
    virtual ~Rows() = default;
    /// The values of `rows` rows of `count` voxels along x, from `first` on, one row behind the other.
    virtual void read(const Int3& first, int count, int rows, T* to) = 0;
    /// Behind the last read: throws FileError unless what was read is sound.
    virtual void finish() {}
};

template <class T>
class StoredRows final : public Rows<T> {
public:
    StoredRows(std::unique_ptr<Values> values, const Selection& selection)
        : m_values(std::move(values)), m_selection(selection), m_reader(*m_values, selection.stride[0]) {}
    void read(const Int3& first, int count, int rows, T* to) override {
        const auto& stride = m_selection.stride;
        const std::uint64_t start = m_selection.placeOf(first);
        const auto length = static_cast<std::uint64_t>(count);
        if (stride[0] == 1 && stride[1] == length)
            return m_reader.readTo(to, start, length * static_cast<std::uint64_t>(rows));
        // Rows that are close together: with what is between them, which is quicker than one by one.
        const bool close = stride[0] == 1 && stride[1] <= 4 * length;
        const int atOnce = close ? static_cast<int>(std::clamp<std::uint64_t>(kValuesAtOnce / stride[1], 1, 4096)) : 1;
        for (int row = 0; row < rows; row += atOnce) {
            const auto piece = static_cast<std::uint64_t>(std::min(atOnce, rows - row));
            readSome(start + static_cast<std::uint64_t>(row) * stride[1], length, piece, to);
            to += length * piece;
        }
    }
    void finish() override { m_values->finish(); }

private:
    static constexpr std::uint64_t kValuesAtOnce = (std::uint64_t{1} << 18) / sizeof(T); // they stay in the cache

    /// `rows` rows of `length` voxels from the file's value `start` on.
    void readSome(std::uint64_t start, std::uint64_t length, std::uint64_t rows, T* to) {
        const auto& stride = m_selection.stride;
        if (rows > 1) {
            m_span.resize(static_cast<std::size_t>((rows - 1) * stride[1] + length));
            m_reader.readTo(m_span.data(), start, m_span.size());
            for (std::uint64_t row = 0; row < rows; ++row)
                to = std::copy_n(m_span.data() + row * stride[1], length, to);
        } else if (stride[0] == 1) {
            m_reader.readTo(to, start, length);
        } else {
            m_reader.readLine(start, length, [&](const T* piece, std::uint64_t voxels) {
                for (std::uint64_t v = 0; v < voxels; ++v) *to++ = piece[v * stride[0]];
            });
        }
    }

    std::unique_ptr<Values> m_values;
    Selection m_selection;
    VoxelReader<T> m_reader;
    std::vector<T> m_span; // rows with what is between them
};

/// Of a volume in pieces. A piece is open from its first row to its last one, unless there are too many: then it is
/// opened anew for each layer.
template <class T>
class PieceRows final : public Rows<T> {
public:
    /// `whole`: of the volume.
    PieceRows(const std::vector<FilePiece>& pieces, const Selection& whole, const JobControl& job)
        : m_whole(whole), m_job(job) {
        for (const FilePiece& piece : pieces) m_pieces.push_back({&piece, nullptr});
    }
    void read(const Int3& first, int count, int rows, T* to) override {
        for (int row = 0; row < rows; ++row, to += count) readRow(first + Int3(0, row, 0), count, to);
    }

private:
    static constexpr std::size_t kMostOpen = 256; // a process may have 1024 files open
    struct Piece {
        const FilePiece* file;
        std::unique_ptr<StoredRows<T>> rows; ///< null: it is not open
    };

    void readRow(const Int3& first, int count, T* to) {
        if (first.z != m_layer) goToLayer(first.z);
        for (Piece* piece : m_inLayer) {
            const VoxelRegion& region = piece->file->region;
            const int begin = std::max(first.x, region.lo.x), end = std::min(first.x + count, region.hi.x);
            if (begin >= end || !hasRow(*piece, first.y)) continue;
            if (!piece->rows) open(*piece, first.y);
            piece->rows->read(Int3(begin, first.y, first.z) - piece->file->first, end - begin, 1,
                              to + (begin - first.x));
        }
    }
    static bool hasRow(const Piece& piece, int y) {
        return y >= piece.file->region.lo.y && y < piece.file->region.hi.y;
    }
    void goToLayer(int z) {
        m_layer = z;
        m_inLayer.clear();
        for (Piece& piece : m_pieces) {
            const bool isIn = z >= piece.file->region.lo.z && z < piece.file->region.hi.z;
            if (isIn) m_inLayer.push_back(&piece);
            if (!isIn) close(piece);
        }
    }
    void open(Piece& piece, int y) {
        for (std::size_t i = 0; m_open >= kMostOpen && i < m_inLayer.size(); ++i)
            if (!hasRow(*m_inLayer[i], y)) close(*m_inLayer[i]);
        Selection selection = m_whole; // its component, and how many there are
        const Int3& dims = piece.file->dims;
        selection.stride[0] = m_whole.components;
        selection.stride[1] = selection.stride[0] * static_cast<std::uint64_t>(dims.x);
        selection.stride[2] = selection.stride[1] * static_cast<std::uint64_t>(dims.y);
        piece.rows = std::make_unique<StoredRows<T>>(openStored<T>(piece.file->values, Wanted::Some, m_job), selection);
        ++m_open;
    }
    void close(Piece& piece) {
        m_open -= piece.rows ? 1u : 0u;
        piece.rows.reset();
    }

    const Selection m_whole;
    const JobControl& m_job;
    std::vector<Piece> m_pieces;
    std::vector<Piece*> m_inLayer; // those with voxels in m_layer
    int m_layer = -1;
    std::size_t m_open = 0;
};

template <class T>
std::unique_ptr<Rows<T>> openRows(const FileLayout& layout, const Selection& selection, const JobControl& job) {
    if (!layout.pieces.empty()) return std::make_unique<PieceRows<T>>(layout.pieces, selection, job);
    return std::make_unique<StoredRows<T>>(openValues<T>(layout, Wanted::Some, job), selection);
}

} // namespace pellucid
