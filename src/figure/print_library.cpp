#include "figure/print_library.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include <cairo-pdf.h>
#include <cairo.h>
#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>
#include <pango/pangofc-font.h>

namespace pellucid {

namespace {

constexpr double kPointsPerMm = 1 / kMmPerPoint;
constexpr double kFine = 50; // units per millimetre of paths, which Cairo rounds to 1/256 of one

struct CairoDeleter {
    void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
    void operator()(cairo_t* c) const { cairo_destroy(c); }
    void operator()(cairo_pattern_t* p) const { cairo_pattern_destroy(p); }
    void operator()(cairo_path_t* p) const { cairo_path_destroy(p); }
    void operator()(cairo_font_options_t* o) const { cairo_font_options_destroy(o); }
    void operator()(PangoLayout* l) const { g_object_unref(l); }
    void operator()(PangoFont* f) const { g_object_unref(f); }
    void operator()(PangoFontDescription* d) const { pango_font_description_free(d); }
};
template <class T>
using Owned = std::unique_ptr<T, CairoDeleter>;

std::string errorOf(cairo_status_t status) {
    return status == CAIRO_STATUS_SUCCESS ? std::string() : cairo_status_to_string(status);
}

// ---------------------------------------------------------------------------------------------------------- texts

Owned<PangoFontDescription> descriptionOf(const std::string& font, double points, bool bold) {
    Owned<PangoFontDescription> description(pango_font_description_new());
    pango_font_description_set_family(description.get(), font.c_str());
    pango_font_description_set_absolute_size(description.get(), points * PANGO_SCALE);
    if (bold) pango_font_description_set_weight(description.get(), PANGO_WEIGHT_BOLD);
    return description;
}

/// In points; letters have the shapes and distances of the font at any size.
Owned<PangoLayout> layoutOf(cairo_t* cr, const FigureText& text, const std::string& font) {
    Owned<PangoLayout> layout(pango_cairo_create_layout(cr));
    PangoContext* const context = pango_layout_get_context(layout.get());
    const Owned<cairo_font_options_t> options(cairo_font_options_create());
    cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
    pango_cairo_context_set_font_options(context, options.get());
    pango_context_set_round_glyph_positions(context, FALSE);
    pango_layout_set_font_description(layout.get(), descriptionOf(font, text.points, text.bold).get());
    pango_layout_set_text(layout.get(), text.text.c_str(), static_cast<int>(text.text.size()));
    if (text.width > 0) {
        pango_layout_set_width(layout.get(), static_cast<int>(std::lround(text.width * kPointsPerMm * PANGO_SCALE)));
        pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
        if (text.lines > 0) {
            pango_layout_set_ellipsize(layout.get(), PANGO_ELLIPSIZE_END);
            pango_layout_set_height(layout.get(), -text.lines);
        }
        constexpr std::array kAligned{PANGO_ALIGN_LEFT, PANGO_ALIGN_CENTER, PANGO_ALIGN_RIGHT};
        pango_layout_set_alignment(layout.get(), kAligned[static_cast<std::size_t>(text.align)]);
    }
    return layout;
}

double shareOf(Align align) { return align == Align::Start ? 0.0 : align == Align::Middle ? 0.5 : 1.0; }

double fromPango(int units) { return static_cast<double>(units) / PANGO_SCALE; }

/// Calls draw() where the current point is the top left corner of the text and units are points.
void placed(cairo_t* cr, const FigureText& text, PangoLayout* layout, const std::function<void()>& draw) {
    PangoRectangle logical;
    pango_layout_get_extents(layout, nullptr, &logical);
    const double width = text.width > 0 ? text.width * kPointsPerMm : fromPango(logical.width);
    cairo_save(cr);
    cairo_matrix_t matrix;
    cairo_matrix_init(&matrix, text.across.x * kMmPerPoint, text.across.y * kMmPerPoint, -text.up.x * kMmPerPoint,
                      -text.up.y * kMmPerPoint, text.at.x, text.at.y);
    cairo_transform(cr, &matrix);
    pango_cairo_update_layout(cr, layout);
    cairo_move_to(cr, -shareOf(text.align) * width, -fromPango(pango_layout_get_baseline(layout)));
    draw();
    cairo_restore(cr);
}

/// A surface that nothing is drawn on, in millimetres.
Owned<cairo_t> sketch() {
    const Owned<cairo_surface_t> surface(cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr));
    Owned<cairo_t> cr(cairo_create(surface.get()));
    cairo_scale(cr.get(), kFine, kFine);
    return cr;
}

double capitalOf(cairo_t* cr, const FigureText& text, const std::string& font) {
    FigureText capital{.text = "H", .points = text.points, .bold = text.bold};
    const Owned<PangoLayout> layout = layoutOf(cr, capital, font);
    PangoRectangle ink;
    pango_layout_get_extents(layout.get(), &ink, nullptr);
    return fromPango(ink.height) * kMmPerPoint;
}

std::string measureText(const FigureText& text, const std::string& font, TextExtent& extent) {
    const Owned<cairo_t> cr = sketch();
    const Owned<PangoLayout> layout = layoutOf(cr.get(), text, font);
    PangoRectangle logical;
    pango_layout_get_extents(layout.get(), nullptr, &logical);
    extent.width = fromPango(logical.width) * kMmPerPoint;
    extent.height = fromPango(logical.height) * kMmPerPoint;
    extent.baseline = fromPango(pango_layout_get_baseline(layout.get())) * kMmPerPoint;
    extent.capital = capitalOf(cr.get(), text, font);
    return errorOf(cairo_status(cr.get()));
}

/// Fonts may have several names: "DejaVu Sans" and "DejaVu Sans Condensed".
std::string familyOf(const std::string& font, std::vector<std::string>& names) {
    const Owned<cairo_t> cr = sketch();
    const Owned<PangoLayout> layout(pango_cairo_create_layout(cr.get()));
    const Owned<PangoFont> chosen(pango_context_load_font(pango_layout_get_context(layout.get()),
                                                          descriptionOf(font, FigureText().points, false).get()));
    if (chosen == nullptr) return {};
    if (PANGO_IS_FC_FONT(chosen.get())) {
        FcPattern* const pattern = pango_fc_font_get_pattern(PANGO_FC_FONT(chosen.get()));
        FcChar8* name = nullptr;
        for (int n = 0; FcPatternGetString(pattern, FC_FAMILY, n, &name) == FcResultMatch; ++n)
            names.emplace_back(reinterpret_cast<const char*>(name));
    }
    if (names.empty()) {
        const Owned<PangoFontDescription> description(pango_font_describe(chosen.get()));
        names.emplace_back(pango_font_description_get_family(description.get()));
    }
    return {};
}

/// Millimetres, to a ten-thousandth.
void append(std::string& path, double number) {
    std::array<char, 32> digits{};
    const double rounded = std::round(number * 1e4) / 1e4 + 0.0;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), rounded, std::chars_format::fixed).ptr;
    path.append(digits.data(), end);
}

std::string pathText(const cairo_path_t& path) {
    std::string text;
    for (int i = 0; i < path.num_data; i += path.data[i].header.length) {
        const cairo_path_data_t* const data = &path.data[i];
        constexpr std::array kLetters{'M', 'L', 'C', 'Z'};
        text += kLetters[static_cast<std::size_t>(data->header.type)];
        for (int p = 1; p < data->header.length; ++p) {
            if (p > 1) text += ' ';
            append(text, data[p].point.x);
            text += ' ';
            append(text, data[p].point.y);
        }
    }
    return text;
}

std::string outlineText(const FigureText& text, const std::string& font, std::string& path) {
    const Owned<cairo_t> cr = sketch();
    const Owned<PangoLayout> layout = layoutOf(cr.get(), text, font);
    placed(cr.get(), text, layout.get(), [&] { pango_cairo_layout_path(cr.get(), layout.get()); });
    const Owned<cairo_path_t> outline(cairo_copy_path(cr.get()));
    if (outline->status != CAIRO_STATUS_SUCCESS) return errorOf(outline->status);
    path = pathText(*outline);
    return errorOf(cairo_status(cr.get()));
}

// -------------------------------------------------------------------------------------------------------- drawing

void setColor(cairo_t* cr, const Rgb& color, double alpha) {
    cairo_set_source_rgba(cr, color.r, color.g, color.b, alpha);
}

std::uint32_t byteOf(double value) {
    return std::isnan(value) ? 0u : static_cast<std::uint32_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

bool isOpaque(const Image& image) {
    for (std::size_t a = 3; a < image.rgba.size(); a += 4)
        if (byteOf(static_cast<double>(image.rgba[a])) < 255) return false;
    return true;
}

Owned<cairo_surface_t> surfaceOf(const Image& image) {
    const bool opaque = isOpaque(image);
    Owned<cairo_surface_t> surface(
        cairo_image_surface_create(opaque ? CAIRO_FORMAT_RGB24 : CAIRO_FORMAT_ARGB32, image.width, image.height));
    if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) return surface;
    unsigned char* const data = cairo_image_surface_get_data(surface.get());
    const int stride = cairo_image_surface_get_stride(surface.get());
    for (int y = 0; y < image.height; ++y) {
        auto* const row = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
        for (int x = 0; x < image.width; ++x) {
            const float* const p = image.pixel(x, y);
            const std::uint32_t a = opaque ? 255 : byteOf(static_cast<double>(p[3]));
            const auto part = [&](int c) { return (byteOf(static_cast<double>(p[c])) * a + 127) / 255; };
            row[x] = a << 24 | part(0) << 16 | part(1) << 8 | part(2);
        }
    }
    cairo_surface_mark_dirty(surface.get());
    return surface;
}

class Painter {
public:
    Painter(cairo_t* cr, const std::string& font) : m_cr(cr), m_font(font) {}

    void operator()(const FigurePicture& picture) const {
        const Owned<cairo_surface_t> pixels = surfaceOf(*picture.image);
        cairo_save(m_cr);
        cairo_translate(m_cr, picture.at.x, picture.at.y);
        cairo_scale(m_cr, picture.width / picture.image->width, picture.height / picture.image->height);
        cairo_set_source_surface(m_cr, pixels.get(), 0, 0);
        cairo_rectangle(m_cr, 0, 0, picture.image->width, picture.image->height);
        cairo_fill(m_cr);
        cairo_restore(m_cr);
    }

    void operator()(const FigureArea& area) const {
        follow(area.corners);
        cairo_close_path(m_cr);
        if (area.stops.empty())
            setColor(m_cr, area.color, area.alpha);
        else
            setGradient(area);
        cairo_fill(m_cr);
    }

    void operator()(const FigureLine& line) const {
        follow(line.points);
        cairo_set_line_width(m_cr, line.width);
        setColor(m_cr, line.color, line.alpha);
        cairo_stroke(m_cr);
    }

    void operator()(const FigureText& text) const {
        const Owned<PangoLayout> layout = layoutOf(m_cr, text, m_font);
        if (text.halo > 0) {
            placed(m_cr, text, layout.get(), [&] { pango_cairo_layout_path(m_cr, layout.get()); });
            cairo_set_line_width(m_cr, 2 * text.halo);
            setColor(m_cr, text.haloColor, kHaloAlpha * text.alpha);
            cairo_stroke(m_cr);
        }
        setColor(m_cr, text.color, text.alpha);
        placed(m_cr, text, layout.get(), [&] { pango_cairo_show_layout(m_cr, layout.get()); });
        cairo_new_path(m_cr);
    }

private:
    void follow(const std::vector<Vec2>& points) const {
        cairo_new_path(m_cr);
        for (const Vec2& p : points) cairo_line_to(m_cr, p.x, p.y);
    }

    void setGradient(const FigureArea& area) const {
        const PixelBox box = boxAround(area.corners);
        const Owned<cairo_pattern_t> gradient(cairo_pattern_create_linear(box.left, 0, box.right, 0));
        for (const FigureStop& stop : area.stops)
            cairo_pattern_add_color_stop_rgba(gradient.get(), stop.at, stop.color.r, stop.color.g, stop.color.b,
                                              area.alpha);
        cairo_set_source(m_cr, gradient.get());
    }

    static PixelBox boxAround(const std::vector<Vec2>& points) {
        PixelBox box{points[0].x, points[0].y, points[0].x, points[0].y};
        for (const Vec2& p : points)
            box = {std::min(box.left, p.x), std::min(box.top, p.y), std::max(box.right, p.x),
                   std::max(box.bottom, p.y)};
        return box;
    }

    cairo_t* m_cr;
    const std::string& m_font;
};

void paint(cairo_t* cr, const Figure& figure) {
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    const Painter painter(cr, figure.font);
    for (const FigureGroup& group : figure.groups) {
        cairo_save(cr);
        if (const auto& c = group.clip) {
            cairo_rectangle(cr, c->left, c->top, c->right - c->left, c->bottom - c->top);
            cairo_clip(cr);
        }
        for (const FigureElement& element : group.elements) std::visit(painter, element);
        cairo_restore(cr);
    }
}

cairo_status_t takeBytes(void* bytes, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

std::string writePdf(const Figure& figure, std::string& bytes) {
    const Owned<cairo_surface_t> surface(cairo_pdf_surface_create_for_stream(
        takeBytes, &bytes, figure.width * kPointsPerMm, figure.height * kPointsPerMm));
    const auto say = [&](cairo_pdf_metadata_t what, const std::string& text) {
        if (!text.empty()) cairo_pdf_surface_set_metadata(surface.get(), what, text.c_str());
    };
    say(CAIRO_PDF_METADATA_TITLE, figure.title);
    say(CAIRO_PDF_METADATA_SUBJECT, figure.description);
    say(CAIRO_PDF_METADATA_CREATOR, "Pellucid");
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, nullptr); // same figure, same bytes
    const Owned<cairo_t> cr(cairo_create(surface.get()));
    cairo_scale(cr.get(), kPointsPerMm, kPointsPerMm);
    paint(cr.get(), figure);
    cairo_show_page(cr.get());
    const std::string error = errorOf(cairo_status(cr.get()));
    cairo_surface_finish(surface.get());
    return error.empty() ? errorOf(cairo_surface_status(surface.get())) : error;
}

std::string drawRaster(const Figure& figure, Image& image) {
    const Owned<cairo_surface_t> surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height));
    const Owned<cairo_t> cr(cairo_create(surface.get()));
    cairo_set_source_rgb(cr.get(), 1, 1, 1);
    cairo_paint(cr.get());
    cairo_scale(cr.get(), image.width / figure.width, image.height / figure.height);
    paint(cr.get(), figure);
    cairo_surface_flush(surface.get());
    if (cairo_status(cr.get()) != CAIRO_STATUS_SUCCESS) return errorOf(cairo_status(cr.get()));
    const unsigned char* const data = cairo_image_surface_get_data(surface.get());
    for (int y = 0; y < image.height; ++y) {
        const auto* const row = reinterpret_cast<const std::uint32_t*>(
            data + static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface.get()));
        for (int x = 0; x < image.width; ++x) {
            float* const p = image.pixel(x, y);
            for (unsigned c = 0; c < 3; ++c) p[c] = static_cast<float>(row[x] >> (16 - 8 * c) & 255) / 255.0f;
            p[3] = 1;
        }
    }
    return {};
}

constexpr PrintLibrary kLibrary{measureText, outlineText, writePdf, drawRaster, familyOf};

} // namespace

} // namespace pellucid

extern "C" const pellucid::PrintLibrary* pellucidPrintLibrary() { return &pellucid::kLibrary; }
