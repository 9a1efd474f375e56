#include "widgets/terms.h"

#include <QSettings>

#include "optimize/answer/visibility_words.h"

namespace pellucid::gui {
namespace {

constexpr const char* kSetting = "scientificNames";

} // namespace

Terms::Terms() : m_chosen(QSettings().value(kSetting).toBool()) {}

Terms& Terms::instance() {
    static Terms terms;
    return terms;
}

void Terms::set(bool& which, bool value) {
    const bool before = areScientific();
    which = value;
    if (areScientific() != before) Q_EMIT changed();
}

void Terms::choose(bool scientific) {
    QSettings().setValue(kSetting, scientific);
    set(m_chosen, scientific);
}

void Terms::setPublished(bool published) { set(m_published, published); }

QString Terms::attention() const { return areScientific() ? tr("VWS") : tr("Attention"); }
QString Terms::visibility() const { return areScientific() ? tr("Visibility") : tr("Seen"); }
QString Terms::pictureSaliency() const { return areScientific() ? tr("2DFS") : tr("In the picture"); }
QString Terms::distance() const { return areScientific() ? tr("F") : tr("Off target"); }

QString Terms::offTarget(double objective) const {
    return areScientific() ? tr("F = %1").arg(objective, 0, 'f', 4) : QString::fromStdString(offTargetText(objective));
}

QString Terms::distanceText(double objective) const {
    return areScientific() ? QString::number(objective, 'f', 4) : QString::fromStdString(percentText(objective));
}

} // namespace pellucid::gui
