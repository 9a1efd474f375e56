#include "foreign/images/image_stack.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>

#include "base/check.h"
#include "base/text.h"
#include "volume/formats/file_check.h"
#include "volume/formats/reader.h"

namespace pellucid {

namespace {

/// Pages of one file that are looked at: each costs a header, and a chain of pages may lead back.
constexpr int kMostPages = 100'000;

FileError failure(const std::string& path, const std::string& what) {
    return {what, path, "copy or write the file again"};
}

void readPlain(const std::string& path, const PlainValues& plain, std::size_t width, std::span<std::byte> to) {
    std::ifstream in(path, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(plain.start));
    in.read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
    if (!in) throw failure(path, "the file ends before its last picture");
    if (width > 1 && plain.bigEndian != (std::endian::native == std::endian::big)) swapBytes(to, width);
}

} // namespace

ImageStack::ImageStack(const std::string& path, const std::string& wanted, const BeforeFile& before, OpenPictures open)
    : m_open(open), m_path(path) {
    if (!wanted.empty())
        throw UsageError("there is no array " + inQuotes(wanted), path, "pictures have no names: leave it out");
    std::error_code ec;
    const bool isFolder = std::filesystem::is_directory(path, ec);
    m_files = isFolder ? imagesIn(path) : std::vector<std::string>{path};
    std::size_t passedOver = 0;
    for (std::size_t f = 0; f < m_files.size(); ++f) {
        before(bytesOfFile(m_files[f]));
        const auto file = m_open(m_files[f]);
        for (int page = 0; page < kMostPages && file->goTo(page); ++page) {
            const PageShape shape = file->shape();
            if (m_pages.empty()) {
                m_shape = shape;
                if (!isFolder)
                    m_order = pageOrderIn(file->description(), file->pixelsPerUnit(0), file->pixelsPerUnit(1));
            } else if (!(shape == m_shape)) {
                if (isFolder)
                    throw failure(m_files[f], "the pictures of this folder are not alike: this one has " +
                                                  textOf(shape) + ", the first " + textOf(m_shape));
                ++passedOver; // a thumbnail, or a coarser copy
                continue;
            }
            m_pages.push_back({f, page, isFolder ? std::nullopt : file->plainPixels()});
            if (isFolder) break; // one picture a file
        }
    }
    if (m_pages.empty()) throw failure(path, "there is no picture in it");
    addPlainPages();
    if (passedOver > 0)
        m_notices.push_back(std::to_string(passedOver) + (passedOver == 1 ? " page" : " pages") +
                            " of another size or type passed over");
    putInOrder();
}

/// The pictures behind the first one, where ImageJ has written no directories of them.
void ImageStack::addPlainPages() {
    if (m_pages.size() != 1 || !m_pages.front().plain || m_order.images < 2) return;
    const PlainValues first = *m_pages.front().plain;
    const std::uint64_t bytes = bytesOf(m_shape), there = bytesOfFile(m_files.front()) - first.start;
    if (there / bytes < static_cast<std::uint64_t>(m_order.images)) return;
    for (int n = 1; n < m_order.images; ++n)
        m_pages.push_back({0, n, PlainValues{first.start + static_cast<std::uint64_t>(n) * bytes, first.bigEndian}});
}

/// The numbers of slices, channels and steps, which have to be those of the pages.
void ImageStack::putInOrder() {
    const auto pages = static_cast<int>(m_pages.size());
    const long long named = static_cast<long long>(std::max(m_order.slices, 1)) * m_order.channels * m_order.steps;
    if (m_order.slices == 0 && m_order.channels == 1 && m_order.steps == 1) {
        m_order.slices = pages;
    } else if (named != pages) {
        m_notices.push_back("the file says that it has " + std::to_string(named) + " pictures, but it has " +
                            std::to_string(pages) + ": they are shown as slices");
        m_order.slices = pages;
        m_order.channels = m_order.steps = 1;
    }
    if (m_shape.samples > 1 && m_order.channels > 1)
        throw failure(m_path, "both pixels and pages have channels, which is not supported");
}

const ImageStack::Page& ImageStack::pageAt(int slice, int channel, int step) const {
    std::size_t at = 0, width = 1;
    for (const char axis : m_order.axes) {
        const int index = axis == 'z' ? slice : axis == 'c' ? channel : step;
        const int size = axis == 'z' ? m_order.slices : axis == 'c' ? m_order.channels : m_order.steps;
        at += width * static_cast<std::size_t>(index);
        width *= static_cast<std::size_t>(size);
    }
    return m_pages.at(at);
}

std::uint64_t ImageStack::largestImageBytes() const { return 2 * bytesOf(m_shape); }

ReaderLayout ImageStack::layout(int step) const {
    requireIndex("time step", step, static_cast<std::uint64_t>(m_order.steps), m_path);
    ReaderLayout answer;
    FileLayout& layout = answer.layout;
    layout.type = m_shape.type;
    if (m_shape.samples > 1) layout.axes.push_back({m_shape.samples, true});
    for (const int size : {m_shape.width, m_shape.height, m_order.slices}) layout.axes.push_back({size});
    if (m_order.channels > 1) layout.axes.push_back({m_order.channels, true});
    layout.spacing = m_order.spacing;
    layout.notices = m_notices;
    findPlain(step, answer);
    return answer;
}

/// Says where the pictures of a step stand in the file, where they need no library.
void ImageStack::findPlain(int step, ReaderLayout& answer) const {
    const std::optional<PlainValues>& first = pageAt(0, 0, step).plain;
    const std::uint64_t bytes = bytesOf(m_shape);
    std::vector<std::uint64_t> starts;
    bool areTogether = true;
    for (int channel = 0; channel < m_order.channels; ++channel)
        for (int slice = 0; slice < m_order.slices; ++slice) {
            const std::optional<PlainValues>& plain = pageAt(slice, channel, step).plain;
            if (!plain || plain->bigEndian != first->bigEndian) return;
            areTogether &= starts.empty() || plain->start == starts.back() + bytes;
            starts.push_back(plain->start);
        }
    if (areTogether) starts.resize(1);
    answer.inFile = std::move(starts);
    answer.layout.bigEndian = first->bigEndian;
}

FileContents ImageStack::contents() const {
    FileContents contents = contentsOf(layout(0).layout);
    contents.steps = m_order.steps;
    if (m_order.stepSeconds > 0 && m_order.steps > 1) {
        contents.timeUnit = "s";
        for (int step = 0; step < m_order.steps; ++step) contents.times.push_back(step * m_order.stepSeconds);
    }
    return contents;
}

void ImageStack::read(int step, const ReaderBox& box, std::span<std::byte> voxels, const BeforeFile& before,
                      const JobControl& job) const {
    const auto sliceBytes = static_cast<std::size_t>(bytesOf(m_shape));
    const glm::ivec2 size(m_shape.width, m_shape.height);
    const std::size_t bytesPerVoxel =
        sliceBytes / (static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    const VoxelRegion& region = box.region;
    const bool isWhole = region.lo.x == 0 && region.lo.y == 0 && region.hi.x == size.x && region.hi.y == size.y;
    std::vector<std::byte> slice(isWhole ? 0 : sliceBytes); // whole ones need no other place
    for (int z = region.lo.z; z < region.hi.z; ++z) {
        const Page& page = pageAt(z, box.component, step);
        if (!page.plain && (!m_file || m_opened != page.file)) {
            m_file = m_open(m_files[page.file]);
            m_opened = page.file;
        }
        before(sliceBytes);
        const std::span<std::byte> to = isWhole ? voxels.first(sliceBytes) : std::span(slice);
        if (page.plain)
            readPlain(m_files[page.file], *page.plain, bytesPerValue(m_shape.type), to);
        else if (m_file->goTo(page.page) && m_file->shape() == m_shape)
            m_file->read(to);
        else
            throw failure(m_files[page.file], "the file has changed while it was read");
        voxels = isWhole ? voxels.subspan(sliceBytes) : copyFromSlice(slice, size, bytesPerVoxel, region, voxels);
        job.throwIfStopped();
        job.report(static_cast<double>(z + 1 - region.lo.z) / static_cast<double>(region.hi.z - region.lo.z));
    }
}

} // namespace pellucid
