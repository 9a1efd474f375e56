#include "widgets/icons.h"

#include <algorithm>

#include <QIconEngine>
#include <QPainter>
#include <QSvgRenderer>

#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

/// Draws it anew at each painting, in the colours of that moment.
class ThemedSvg : public QIconEngine {
public:
    explicit ThemedSvg(QByteArray svg) : m_svg(std::move(svg)) {}

    void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State) override {
        const QColor color = mode == QIcon::Disabled ? between(theme::kWindow, theme::kText, 0.35) : theme::kText;
        QByteArray svg = m_svg;
        QSvgRenderer(svg.replace("currentColor", color.name().toLatin1())).render(painter, QRectF(rect));
    }
    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        QPixmap pixmap(size);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        paint(&painter, QRect({}, size), mode, state);
        return pixmap;
    }
    QIconEngine* clone() const override { return new ThemedSvg(*this); }

private:
    QByteArray m_svg;
};

} // namespace

QIcon iconNamed(const QString& action) {
    const std::vector<IconFile>& files = iconFiles();
    const auto file = std::ranges::find_if(files, [&](const IconFile& f) { return action + ".svg" == f.name; });
    return file == files.end() ? QIcon() : QIcon(new ThemedSvg(file->svg));
}

} // namespace pellucid::gui
