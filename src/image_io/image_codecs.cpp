#include "image_io/image_codecs.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace pellucid {

namespace {

OIIO::TypeDesc typeOf(SampleKind kind) {
    switch (kind) {
    case SampleKind::Bytes:
        return OIIO::TypeDesc::UINT8;
    case SampleKind::Shorts:
        return OIIO::TypeDesc::UINT16;
    case SampleKind::Floats:
        break;
    }
    return OIIO::TypeDesc::FLOAT;
}

std::string encode(const ImageToEncode& image, const std::string& suffix, std::vector<unsigned char>& bytes) {
    const auto out = OIIO::ImageOutput::create("image" + suffix);
    if (!out || !out->supports("ioproxy")) return "no writer for this kind of image";
    OIIO::ImageSpec spec(image.width, image.height, image.channels, typeOf(image.samples));
    spec.attribute("oiio:ColorSpace", image.kind == ValueKind::Colors ? "sRGB" : "Linear");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    // OpenImageIO 2.4 spoils a TIFF in memory by a directory for Exif tags, which would only say sRGB.
    spec.attribute("tiff:write_exif", 0);
    spec.attribute("DateTime", ""); // else it writes the present one, and no two files are the same
    if (!image.channelNames.empty()) {
        spec.channelnames = image.channelNames;
        spec.alpha_channel = spec.channelindex("A");
        spec.z_channel = -1;
    }
    for (const auto& [name, text] : image.texts) spec.attribute(name, text);
    if (!image.iccProfile.empty())
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(image.iccProfile.size())),
                       image.iccProfile.data());
    OIIO::Filesystem::IOVecOutput memory(bytes);
    void* proxy = &memory;
    spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto stride = static_cast<OIIO::stride_t>(image.valuesPerPixel * sizeof(float));
    const bool good = out->open("image" + suffix, spec) &&
                      out->write_image(OIIO::TypeDesc::FLOAT, image.values, stride) && out->close();
    const std::string error = out->geterror(); // some come without a failure
    return good || !error.empty() ? error : "it does not say why";
}

std::string decode(const std::string& path, DecodedImage& image) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto in = OIIO::ImageInput::open(path, &config);
    if (!in) return OIIO::geterror();
    const OIIO::ImageSpec& spec = in->spec();
    image = {spec.width, spec.height, spec.nchannels, spec.alpha_channel, {}};
    image.values.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                        static_cast<std::size_t>(spec.nchannels));
    if (in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data())) return {};
    const std::string error = in->geterror();
    return error.empty() ? "it does not say why" : error;
}

} // namespace

} // namespace pellucid

extern "C" const pellucid::ImageCodecs* pellucidImageCodecs() {
    static const pellucid::ImageCodecs codecs{pellucid::encode, pellucid::decode};
    return &codecs;
}
