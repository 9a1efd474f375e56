#include "figure/print.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include <dlfcn.h>

#include "base/error.h"
#include "base/memory.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

/// Address space of Pango, its threads and the fonts: where it runs out within them, GLib ends the program.
constexpr std::uint64_t kPrintBytes = 96u << 20;

/// Beside the program, as built, or where it is installed.
std::string pathOfLibrary() {
    std::error_code ec;
    const fs::path folder = fs::read_symlink("/proc/self/exe", ec).parent_path();
    const fs::path beside = folder / PELLUCID_PRINT_LIBRARY;
    return (fs::exists(beside, ec) ? beside : folder / PELLUCID_LIBRARIES_FROM_PROGRAMS / PELLUCID_PRINT_LIBRARY)
        .string();
}

const PrintLibrary& library() {
    static const PrintLibrary& loaded = []() -> const PrintLibrary& {
        const std::string path = pathOfLibrary();
        requireMemory("setting the letters of a figure", path, kPrintBytes);
        void* const handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* const symbol = handle == nullptr ? nullptr : ::dlsym(handle, kPrintLibrarySymbol);
        if (symbol == nullptr) {
            const char* const why = ::dlerror();
            std::error_code ec;
            if (!fs::exists(path, ec))
                throw FileError("the part of the program that makes figures for print is not installed", path,
                                "install the package pellucid-images, or make a picture");
            throw FileError(std::string("the part of the program that makes figures for print cannot be loaded (") +
                                (why == nullptr ? "no reason given" : why) + ")",
                            path, "install the program again");
        }
        return *reinterpret_cast<const PrintLibrary* (*)()>(symbol)();
    }();
    return loaded;
}

void require(const std::string& error) {
    if (!error.empty()) throw Error("the figure cannot be made (" + error + ")", "", "make it smaller");
}

} // namespace

TextExtent extentOf(const FigureText& text, const std::string& font) {
    TextExtent extent;
    require(library().measure(text, font, extent));
    return extent;
}

std::string outlineOf(const FigureText& text, const std::string& font) {
    std::string path;
    require(library().outline(text, font, path));
    return path;
}

std::string pdfOf(const Figure& figure) {
    std::string bytes;
    require(library().pdf(figure, bytes));
    return bytes;
}

Image rasterOf(const Figure& figure, int width) {
    Image image(width, std::max(1, static_cast<int>(std::lround(width * figure.height / figure.width))));
    require(library().raster(figure, image));
    return image;
}

std::vector<std::string> familyOf(const std::string& font) {
    std::vector<std::string> names;
    require(library().family(font, names));
    return names;
}

} // namespace pellucid
