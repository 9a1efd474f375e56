#include "foreign/images/image_stack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "base/check.h"
#include "base/text.h"
#include "volume/file_names.h"
#include "volume/formats/file_check.h"
#include "volume/formats/reader.h"
#include "volume/spacing.h"

namespace pellucid {

namespace {

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

/// "1 page", "2 pages".
std::string pagesText(std::size_t count) { return std::to_string(count) + (count == 1 ? " page" : " pages"); }

/// How far indices are apart, all alike; 0 where they are not, 1 where there is one.
int stepOf(const std::set<int>& indices) {
    if (indices.size() < 2) return 1;
    const int step = *std::next(indices.begin()) - *indices.begin();
    return *indices.rbegin() - *indices.begin() == step * (static_cast<int>(indices.size()) - 1) &&
                   std::ranges::adjacent_find(indices, [=](int a, int b) { return b - a != step; }) == indices.end()
               ? step
               : 0;
}

/// Of a page that may be none of this image's; empty: of a type that cannot be read.
std::optional<PageShape> shapeOfAny(PictureFile& file) {
    try {
        return file.shape();
    } catch (const FileError&) {
        return {};
    }
}

FirstPage firstPageOf(PictureFile& file, const std::string& path) {
    return {file.description(), file.pixelsPerUnit(0), file.pixelsPerUnit(1), shapeOfAny(file).value_or(PageShape{}),
            std::filesystem::path(path).filename().string()};
}

UsageError hasNoNames(const std::string& path, const std::string& wanted) {
    return {"there is no image " + inQuotes(wanted), path, "pictures have no names: leave it out"};
}

/// Which image is wanted: by its name or, where none has this name, by its number from 1. Without a wish the first that
/// is in this file. Throws UsageError where there is none.
std::size_t chosenOf(const std::vector<ImageInFile>& all, const std::string& wanted, const std::string& path) {
    if (wanted.empty()) {
        const auto first = std::ranges::find_if(all, [](const ImageInFile& image) { return image.elsewhere.empty(); });
        return first == all.end() ? 0 : static_cast<std::size_t>(first - all.begin());
    }
    if (all.empty()) throw hasNoNames(path, wanted);
    auto found = std::ranges::find(all, wanted, &ImageInFile::name);
    for (std::size_t i = 0; i < all.size() && found == all.end(); ++i)
        if (wanted == std::to_string(i + 1)) found = all.begin() + static_cast<std::ptrdiff_t>(i);
    if (found == all.end()) {
        constexpr std::size_t kMostNamed = 20;
        const auto nameOf = [](const ImageInFile& image) { return inQuotes(image.name); };
        throw UsageError("there is no image " + inQuotes(wanted), path,
                         "there " + std::string(all.size() == 1 ? "is " : "are ") +
                             joined(std::span(all).first(std::min(all.size(), kMostNamed)), ", ", nameOf) +
                             (all.size() > kMostNamed ? ", …" : ""));
    }
    if (!found->elsewhere.empty())
        throw UsageError("image " + inQuotes(found->name) + " is not in this file", path, "open " + found->elsewhere);
    return static_cast<std::size_t>(found - all.begin());
}

/// Whether pixels are as far apart, but for rounding.
bool isSameSpacing(const SliceMetadata& a, const SliceMetadata& b) {
    if ((a.lengthUnit == LengthUnit::Unknown) != (b.lengthUnit == LengthUnit::Unknown)) return false;
    constexpr double kRounding = 1e-5;
    for (int axis = 0; axis < 3; ++axis) {
        if (axis == 2 && !a.isApartKnown) continue;
        const double other = converted(b.spacing[axis], b.lengthUnit, a.lengthUnit);
        if (std::abs(a.spacing[axis] - other) > kRounding * a.spacing[axis]) return false;
    }
    return a.isApartKnown == b.isApartKnown;
}

} // namespace

ImageStack::ImageStack(const std::string& path, const std::string& wanted, const BeforeFile& before, OpenPictures open)
    : m_open(open), m_path(path) {
    std::error_code ec;
    const bool isFolder = std::filesystem::is_directory(path, ec);
    if (isFolder && !wanted.empty()) throw hasNoNames(path, wanted);
    m_files = isFolder ? imagesIn(path) : std::vector<std::string>{path};
    std::size_t passedOver = 0, others = 0;
    std::set<int> named;               // where the file says which pages it means
    std::set<std::string> saidOfPages; // each once
    for (std::size_t f = 0; f < m_files.size(); ++f) {
        before(bytesOfFile(m_files[f]));
        const auto file = m_open(m_files[f]);
        for (int page = 0; page < kMostPages && file->goTo(page); ++page) {
            if (page == 0 && isFolder) compareMetadata(*file, f);
            if (page == 0 && !isFolder) {
                findOrder(*file, wanted);
                named.insert(m_order.pages.begin(), m_order.pages.end());
            }
            if (!named.empty() && !named.contains(page)) { // of another image
                ++others;
                continue;
            }
            if (m_pages.empty()) {
                m_shape = file->shape();
            } else if (isFolder && !(file->shape() == m_shape)) {
                throw failure(m_files[f], "the pictures of this folder are not alike: this one has " +
                                              textOf(file->shape()) + ", the first " + textOf(m_shape));
            } else if (!isFolder && shapeOfAny(*file) != m_shape) {
                ++passedOver; // a thumbnail, or a coarser copy
                continue;
            }
            m_pages.push_back({f, page, isFolder ? std::nullopt : file->plainPixels()});
            for (const std::string& text : file->notices())
                if (saidOfPages.insert(text).second) m_notices.push_back(text);
            if (isFolder) break; // one picture a file
        }
    }
    if (m_pages.empty())
        throw failure(path, others > 0 ? "its OME-XML names pages that it does not have" : "there is no picture in it");
    addPlainPages();
    m_notices.insert(m_notices.begin(), m_order.notices.begin(), m_order.notices.end());
    if (others > 0 && m_imageNames.empty()) // where there are several images, they are of these
        m_notices.push_back(pagesText(others) +
                            (others == 1 ? " does not belong to this image, according to its OME-XML, and is left out"
                                         : " do not belong to this image, according to its OME-XML, and are left out"));
    if (passedOver > 0) m_notices.push_back(pagesText(passedOver) + " of another size or type passed over");
    if (isFolder) noteMissing();
    if (isFolder) noteMetadata();
    putInOrder();
}

/// What the first page of a file, where it stands, says of its pages: of those of the image that is wanted.
void ImageStack::findOrder(PictureFile& file, const std::string& wanted) {
    FirstPage first = firstPageOf(file, m_path);
    const std::vector<ImageInFile> all = imagesNamedIn(first);
    first.image = chosenOf(all, wanted, m_path);
    if (all.size() < 2) {
        m_order = pageOrderIn(first);
        return;
    }
    const ImageInFile& image = all[first.image];
    if (image.firstPage > 0 && file.goTo(image.firstPage)) first.shape = shapeOfAny(file).value_or(first.shape);
    file.goTo(0);
    m_order = pageOrderIn(first);
    m_image = image.name;
    for (const ImageInFile& one : all) {
        m_imageNames.push_back(one.name);
        m_imageDetails.push_back(one.details);
    }
    const std::string number = std::to_string(first.image + 1) + " of " + std::to_string(all.size());
    if (m_order.pages.empty() && first.image > 0)
        throw FileError("its OME-XML does not say which pages are those of image " + number + ", " + inQuotes(m_image),
                        m_path, "save this image in a file of its own");
    if (wanted.empty())
        m_order.notices.insert(m_order.notices.begin(), "image " + number + ", " + inQuotes(m_image) + ", is shown");
}

/// Holds what a file of a folder, the one of this number, says of its pixels against the first one.
void ImageStack::compareMetadata(PictureFile& file, std::size_t number) {
    constexpr std::uint64_t kMostText = 8u << 20; // OME-XML may describe all files in each
    if (!m_otherSpacing.empty() && !m_otherScaling.empty()) return;
    const FirstPage page = firstPageOf(file, m_files[number]);
    m_textBytes += page.description.size();
    if (m_sliceMetadata && m_textBytes > kMostText) return;
    SliceMetadata metadata = sliceMetadataIn(page);
    if (!m_sliceMetadata) {
        m_sliceMetadata = std::move(metadata);
        return;
    }
    if (m_otherSpacing.empty() && !isSameSpacing(*m_sliceMetadata, metadata)) m_otherSpacing = m_files[number];
    if (m_otherScaling.empty() && m_sliceMetadata->scaling != metadata.scaling) m_otherScaling = m_files[number];
}

/// Takes the spacing and the calibration of values that the files of a folder state, and says what they leave open.
void ImageStack::noteMetadata() {
    const auto nameOf = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
    const SliceMetadata& first = *m_sliceMetadata;
    m_order.spacing = first.spacing;
    m_order.lengthUnit = first.lengthUnit;
    m_notices.insert(m_notices.end(), first.notices.begin(), first.notices.end());
    if (!m_otherSpacing.empty())
        m_notices.push_back(nameOf(m_otherSpacing) + " says another distance between pixels than " +
                            nameOf(m_files.front()) + ", which is taken for all pictures");
    if (!first.isApartKnown && first.spacing != Vec3(1))
        m_notices.emplace_back(std::string("the files do not say how far slices are apart: 1 is taken") + kUnlessSet);
    if (m_otherScaling.empty())
        m_order.scaling = first.scaling;
    else
        m_notices.push_back(nameOf(m_otherScaling) + " has another calibration of values than " +
                            nameOf(m_files.front()) + ": the stored values are shown");
}

/// Says which numbers are missing between those of the pictures in a folder.
void ImageStack::noteMissing() {
    const std::optional<NumberedNames> names = numberedNames(m_files);
    const std::optional<NumberGaps> gaps = names ? gapsIn(names->numbers) : std::nullopt;
    if (!gaps) return;
    std::string which;
    if (gaps->missing <= names->numbers.size()) { // more would be no gaps
        const std::set<std::int64_t> there(names->numbers.begin(), names->numbers.end());
        std::vector<std::string> missing;
        for (std::int64_t number = *there.begin(); number < *there.rbegin(); number += gaps->step)
            if (!there.contains(number)) missing.push_back(names->name.with(number));
        which = " (" + someNames(missing) + ")";
    }
    m_notices.push_back(std::to_string(gaps->missing) + (gaps->missing == 1 ? " picture is" : " pictures are") +
                        " missing between the numbered ones" + which +
                        ": the slices before and behind lie next to each other");
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

/// The pages in the order in which the file names them. Where it lacks some, or others have them, those that are there,
/// if these are a block of slices, channels and steps.
void ImageStack::pickPictures() {
    std::map<int, std::size_t> places; // in m_pages
    for (std::size_t i = 0; i < m_pages.size(); ++i) places[m_pages[i].page] = i;
    std::map<char, std::set<int>> there; // indices along each axis
    std::vector<Page> found;
    for (std::size_t n = 0; n < m_order.pages.size(); ++n) {
        const auto place = places.find(m_order.pages[n]);
        if (place == places.end()) continue;
        found.push_back(m_pages[place->second]);
        auto rest = static_cast<int>(n);
        for (const char axis : m_order.axes) {
            there[axis].insert(rest % m_order.sizeAlong(axis));
            rest /= m_order.sizeAlong(axis);
        }
    }
    const int sliceStep = stepOf(there['z']), timeStep = stepOf(there['t']); // channels may be any
    if (found.size() != there['z'].size() * there['c'].size() * there['t'].size() || sliceStep == 0 || timeStep == 0)
        return;
    const std::size_t expected = m_order.pages.size() - static_cast<std::size_t>(m_order.elsewhere);
    if (found.size() < expected)
        m_notices.push_back("the file says that it has " + std::to_string(expected) + " pictures, but it has " +
                            std::to_string(found.size()));
    m_pages = std::move(found);
    m_order.slices = static_cast<int>(there['z'].size());
    m_order.channels = static_cast<int>(there['c'].size());
    m_order.steps = static_cast<int>(there['t'].size());
    m_order.spacing.z *= sliceStep;
    m_order.stepSeconds *= timeStep;
}

/// The numbers of slices, channels and steps, which have to be those of the pages.
void ImageStack::putInOrder() {
    if (!m_order.pages.empty()) pickPictures();
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
        at += width * static_cast<std::size_t>(index);
        width *= static_cast<std::size_t>(m_order.sizeAlong(axis));
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
    layout.lengthUnit = m_order.lengthUnit;
    layout.scaling = m_order.scaling;
    layout.array = m_image;
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
    contents.arrays = m_imageNames;
    contents.details = m_imageDetails;
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
