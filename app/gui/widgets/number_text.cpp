#include "widgets/number_text.h"

#include <cmath>

namespace pellucid::gui {

QString numberText(double value, double span) { return QString::fromStdString(pellucid::numberText(value, span)); }

QString shortNumber(double value) { return QString::number(value, 'g', 3).replace('-', QChar(0x2212)); }

QString rangeText(const ValueRange& range) {
    const double span = range.hi - range.lo;
    return QStringLiteral("%1 – %2").arg(numberText(range.lo, span), numberText(range.hi, span));
}

QString stepText(double inD0) {
    const double per = 1 / inD0;
    if (inD0 < 1 && std::abs(per - std::round(per)) < 1e-9) return QStringLiteral("1/%1").arg(std::round(per));
    return QString::fromStdString(shortText(inD0));
}

QString placeText(const Geometry& geometry, PatientAxes axes, const Vec3& world) {
    const double size = 2 * geometry.radius();
    const Vec3 place = inAxes(axes, geometry, world);
    const QString text = QStringLiteral("%1, %2, %3 %4")
                             .arg(numberText(place.x, size), numberText(place.y, size), numberText(place.z, size),
                                  QString::fromUtf8(lengthUnit(geometry)));
    const std::string letters = coordinatesText(axes, geometry);
    return letters.empty() ? text : QStringLiteral("%1 (%2)").arg(text, QString::fromStdString(letters));
}

} // namespace pellucid::gui
