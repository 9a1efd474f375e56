#include "render/gl/measure_buffers.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/parallel.h"
#include "render/gl/volume_texture.h"

namespace pellucid::gl {

namespace {

constexpr int kReduceColumns = 16; ///< local_size_x of visibility_reduce.comp

/// Overwrites the beginning of a buffer that is large enough.
void write(const Buffer& buffer, const void* data, std::size_t bytes) {
    PELLUCID_CHECK(bytes <= buffer.bytes);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name.id());
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
}

} // namespace

void bindStorage(GLuint binding, const Buffer& buffer) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.name.id());
}

void ensureStorage(Buffer& buffer, double bytes, const std::string& what) {
    const auto size = static_cast<std::size_t>(std::max(bytes, 16.0));
    if (buffer.bytes >= size) return;
    buffer = {}; // before the new one, so that both never need room at once
    buffer = makeBuffer(GL_SHADER_STORAGE_BUFFER, size, nullptr, GL_DYNAMIC_COPY, what);
}

void TableBuffers::upload(const DepthTables& tables) {
    const std::size_t bytes = tables.tau.size() * sizeof(float),
                      counts = tables.opaqueBefore.size() * sizeof(std::uint32_t);
    const std::string what = "the transfer functions' tables";
    ensureStorage(m_integral, static_cast<double>(bytes), what);
    ensureStorage(m_tau, static_cast<double>(bytes), what);
    ensureStorage(m_opaque, static_cast<double>(counts), what);
    write(m_integral, tables.integral.data(), bytes);
    write(m_tau, tables.tau.data(), bytes);
    write(m_opaque, tables.opaqueBefore.data(), counts);
    bindStorage(1, m_integral);
    bindStorage(2, m_tau);
    bindStorage(3, m_opaque);
    throwOnGlError("uploading the transfer functions");
}

void TableBuffers::describe(const Program& program, const DepthTables& tables, int maxCode) {
    program.set(0, 65535.0 / maxCode * tables.cells);
    program.set(12, tables.unit);
    program.set(13, tables.cells - 1);
}

void describeVolume(const Program& program, const ResidentVolume& volume, const Mat3& voxelFrom, const Vec3& offset) {
    program.set(10, voxelFrom);
    program.set(11, offset);
    program.set(14, volume.size() - 1);
    program.set(15, Vec3(volume.codes().size));
    const Folding& f = volume.folding();
    if (!f.folded()) return;
    program.set(16, f.brick);
    program.set(17, f.bricks);
    program.set(18, f.slots);
    program.set(19, f.tile);
}

void gatherVoxels(const Program& program, const Int3& voxels) {
    program.use();
    glDispatchCompute(groups(voxels.x, kGroupSide), groups(voxels.y, kGroupSide), groups(voxels.z, kPlanesPerGroup));
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
}

void readVisibility(const Buffer& buffer, std::size_t count, const std::function<void(std::span<const float>)>& use) {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name.id());
    const void* data =
        glMapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(count * sizeof(float)), GL_MAP_READ_BIT);
    throwOnGlError("reading the visibility");
    if (data == nullptr) throw Error("the visibility cannot be read back", "OpenGL", "", Remedy::OtherEngine);
    const struct Unmap {
        ~Unmap() { glUnmapBuffer(GL_SHADER_STORAGE_BUFFER); }
    } unmap;
    use({static_cast<const float*>(data), count});
}

int slotsFor(int features) {
    int slots = 4;
    while (slots < features + 1) slots *= 2;
    return slots;
}

int segmentsFor(int candidates, int slots) {
    const int group = kGroupSide * kGroupSide;
    const int staged = group * 4 * (1 + candidates + 3) + 4;
    const int room = (glInteger(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE) - staged) / (slots * 3 * candidates * 4);
    return std::min(room, group / (3 * candidates));
}

std::vector<std::string> definesFor(const ResidentVolume& volume, int candidates, int slots, bool clipped, bool faint) {
    std::vector<std::string> defines{"CANDIDATES " + std::to_string(candidates)};
    if (volume.hasInvalid()) defines.push_back("HAS_INVALID");
    if (volume.folding().folded()) defines.push_back("FOLDED");
    if (clipped) defines.push_back("CLIPPED");
    if (faint) defines.push_back("FAINT");
    if (slots == 0) {
        defines.push_back("FIELD");
    } else {
        defines.push_back("SLOTS " + std::to_string(slots));
        defines.push_back("SEGMENTS " + std::to_string(segmentsFor(candidates, slots)));
    }
    return defines;
}

void refuseTooManyFeatures(int features) {
    if (features + 1 > kMostSlots)
        throw Error("at most " + std::to_string(kMostSlots - 1) + " features can be measured", "transfer function",
                    "join some");
}

std::vector<std::uint16_t> slotsOfCodes(const IntensityGrid& grid, const std::vector<Feature>& features) {
    const int maxCode = textureMaxCode(grid);
    std::vector<std::uint16_t> slots(static_cast<std::size_t>(maxCode) + 1);
    for (std::size_t code = 0; code < slots.size(); ++code) {
        const int f = featureAt(features, static_cast<double>(code) / maxCode);
        slots[code] = static_cast<std::uint16_t>(f < 0 ? static_cast<int>(features.size()) : f);
    }
    return slots;
}

FeatureTotals::FeatureTotals() : m_reduce({"visibility_reduce.comp"}) {}

void FeatureTotals::begin(const std::vector<std::uint16_t>& slotOfCode, int entries) {
    if (m_uploadedSlots != slotOfCode) {
        std::vector<std::uint16_t> padded = slotOfCode;
        padded.resize(2 * ((padded.size() + 1) / 2));
        ensureStorage(m_slotOfCode, static_cast<double>(padded.size() * sizeof(std::uint16_t)), "the features");
        write(m_slotOfCode, padded.data(), padded.size() * sizeof(std::uint16_t));
        m_uploadedSlots = slotOfCode;
    }
    bindStorage(4, m_slotOfCode);
    m_entries = entries;
    m_first = true;
    ensureStorage(m_totals, 8.0 * entries, "the sums");
    bindStorage(6, m_totals);
}

void FeatureTotals::add(GLuint workGroups) {
    m_reduce.set(0, m_entries);
    m_reduce.set(1, static_cast<GLint>(workGroups));
    m_reduce.set(2, m_first);
    m_reduce.use();
    glDispatchCompute(groups(m_entries, kReduceColumns), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    m_first = false;
}

std::vector<double> FeatureTotals::read() const {
    std::vector<double> totals(static_cast<std::size_t>(m_entries), 0.0);
    if (m_first) return totals; // there was nothing to add
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, m_totals.name.id());
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(totals.size() * sizeof(double)),
                       totals.data());
    throwOnGlError("reading the sums");
    return totals;
}

DeviceEngine::DeviceEngine(std::shared_ptr<const Volume> volume, Quality quality)
    : m_volume(std::move(volume)), m_quality(quality), m_codes(sharedIntensityGrid(*m_volume)),
      m_cells(tableCells(*m_volume, quality)) {}

SumsJacobian DeviceEngine::jacobian(const View& view, const TransferFunction& tf, const WeightFields* weights,
                                    const JobControl& job) {
    if (!m_cpu) m_cpu = makeCpuEngine(m_volume, m_quality);
    return m_cpu->jacobian(view, tf, weights, job);
}

void DeviceEngine::check(const View& view, std::span<const TransferFunction> tfs, const WeightFields* weights) const {
    view.camera.validate(m_volume->geometry(), "camera");
    view.clipping.validate();
    for (const TransferFunction& tf : tfs) PELLUCID_CHECK(tf.features == tfs.front().features);
    if (weights != nullptr) PELLUCID_CHECK(weights->dims() == m_volume->dims());
}

std::uint64_t keyOf(const WeightFields& weights) {
    // Compact weights, a byte each, in whole words; there is room behind the last.
    const bool compact = weights.isCompact();
    const auto* words = compact ? reinterpret_cast<const std::uint32_t*>(weights.compactData()) : weights.data();
    const std::size_t count = compact ? (weights.size() + 3) / 4 : weights.size();
    constexpr std::size_t kPiece = 1 << 20;
    std::vector<std::uint64_t> parts((count + kPiece - 1) / kPiece);
    parallelFor(parts.size(), [&](std::size_t part) {
        std::array<std::uint64_t, 4> hash{1, 2, 3, 4}; // four chains, so that multiplications overlap
        const std::size_t end = std::min(count, (part + 1) * kPiece);
        for (std::size_t i = part * kPiece; i < end; ++i)
            hash[i & 3] = (hash[i & 3] ^ words[i]) * 0x9e3779b97f4a7c15u + (hash[i & 3] >> 29);
        parts[part] = hash[0] ^ (hash[1] << 1) ^ (hash[2] << 2) ^ (hash[3] << 3);
    });
    std::uint64_t key = count;
    for (const std::uint64_t part : parts) key = (key ^ part) * 0x9e3779b97f4a7c15u + (key >> 29);
    return key;
}

} // namespace pellucid::gl
