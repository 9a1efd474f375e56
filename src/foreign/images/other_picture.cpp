#include "foreign/images/other_picture.h"

#include <OpenImageIO/imageio.h>

namespace pellucid {

namespace {

class OtherFile final : public PictureFile {
public:
    explicit OtherFile(const std::string& path) : m_path(path) {
        OIIO::attribute("threads", 1);
        OIIO::ImageSpec asked;
        asked["oiio:UnassociatedAlpha"] = 1; // numbers as they are stored
        asked["oiio:RawColor"] = 1;
        m_file = OIIO::ImageInput::open(path, &asked);
        if (!m_file) throw pictureFailure(path, "this picture cannot be read", OIIO::geterror());
    }
    bool goTo(int page) override { return page == 0; }
    PageShape shape() override {
        const OIIO::ImageSpec& spec = m_file->spec();
        if (spec.width < 1 || spec.height < 1 || spec.depth > 1 ||
            (spec.format != OIIO::TypeDesc::UINT8 && spec.format != OIIO::TypeDesc::UINT16))
            throw pictureFailure(m_path, "pictures of this kind are not supported");
        return {spec.width, spec.height, spec.nchannels,
                spec.format == OIIO::TypeDesc::UINT8 ? ValueType::U8 : ValueType::U16};
    }
    std::vector<std::string> notices() override {
        const std::string text = orientationNotice(m_file->spec().get_int_attribute("Orientation", 1));
        return text.empty() ? std::vector<std::string>() : std::vector{text};
    }
    void read(std::span<std::byte> to) override {
        const PageShape page = shape();
        const OIIO::TypeDesc type = page.type == ValueType::U8 ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16;
        if (!m_file->read_image(0, 0, 0, page.samples, type, to.data()) || m_file->has_error())
            throw pictureFailure(m_path, "this picture cannot be read", m_file->geterror());
    }

private:
    std::string m_path;
    std::unique_ptr<OIIO::ImageInput> m_file;
};

} // namespace

std::unique_ptr<PictureFile> openOtherPicture(const std::string& path) { return std::make_unique<OtherFile>(path); }

} // namespace pellucid
