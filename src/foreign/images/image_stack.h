// Pictures as slices of a volume: TIFF files of many pages, and folders of pictures. Runs in pellucid-tiff-reader and
// pellucid-image-reader only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "foreign/foreign_volume.h"
#include "foreign/images/page_words.h"
#include "foreign/images/picture_file.h"

namespace pellucid {

/// Opens a file of pictures; throws FileError.
using OpenPictures = std::unique_ptr<PictureFile> (*)(const std::string& path);

class ImageStack final : public ForeignVolume {
public:
    /// `path`: a TIFF file, or a folder of pictures of one size in the order in which people count. `wanted`: an image
    /// that OME-XML names, or its number from 1; empty: the first one in this file. Throws FileError for what cannot be
    /// read, or where pictures are not alike, UsageError where there is not the image that is wanted.
    ImageStack(const std::string& path, const std::string& wanted, const BeforeFile& before, OpenPictures open);

    FileContents contents() const override;
    std::vector<std::string> files() const override { return m_files; }
    ReaderLayout layout(int step) const override;
    std::uint64_t largestImageBytes() const override;
    void read(int step, const ReaderBox& box, std::span<std::byte> voxels, const BeforeFile& before,
              const JobControl& job) const override;

private:
    /// A picture: page `page` of file `file`.
    struct Page {
        std::size_t file = 0;
        int page = 0;
        std::optional<PlainValues> plain = {}; ///< of TIFF files that are read alone
    };
    const Page& pageAt(int slice, int channel, int step) const;
    void addPlainPages();
    void noteMissing();
    void findOrder(PictureFile& file, const std::string& wanted);
    void compareMetadata(PictureFile& file, std::size_t number);
    void noteMetadata();
    void pickPictures();
    void putInOrder();
    void findPlain(int step, ReaderLayout& answer) const;

    OpenPictures m_open;
    std::string m_path;
    std::vector<std::string> m_files;
    std::vector<Page> m_pages;                             ///< as they follow each other
    PageOrder m_order;                                     ///< with all numbers known
    PageShape m_shape;                                     ///< of all pages
    std::string m_image;                                   ///< which image of the file this is; empty: it has one
    std::vector<std::string> m_imageNames, m_imageDetails; ///< of all images, where there are several
    std::optional<SliceMetadata> m_sliceMetadata;          ///< of a folder: what its first file says
    std::uint64_t m_textBytes = 0;                         ///< of texts that were searched for it
    std::string m_otherSpacing, m_otherScaling;            ///< the first file that says something else
    std::vector<std::string> m_notices;
    mutable std::unique_ptr<PictureFile> m_file; ///< the one that was read last: boxes follow each other
    mutable std::size_t m_opened = 0;            ///< which it is
};

} // namespace pellucid
