#include "number_text.h"

namespace pellucid::gui {

QString numberText(double value, double span) { return QString::fromStdString(pellucid::numberText(value, span)); }

QString rangeText(const ValueRange& range) {
    const double span = range.hi - range.lo;
    return QStringLiteral("%1 – %2").arg(numberText(range.lo, span), numberText(range.hi, span));
}

} // namespace pellucid::gui
