#include "widgets/spoken_value.h"

#include <algorithm>
#include <utility>

#include <QAccessibleWidget>
#include <QEvent>
#include <QTimer>
#include <QWidget>

namespace pellucid::gui {
namespace {

constexpr int kRest = 150; // ms: of a drag, or of a key that is held, only the end is told

// While a widget goes, it is none of ours any more.
Spoken* spokenOf(QObject* object) { return dynamic_cast<Spoken*>(object); }

class SpokenInterface : public QAccessibleWidget, public QAccessibleValueInterface {
public:
    using QAccessibleWidget::QAccessibleWidget;

    QString text(QAccessible::Text which) const override {
        const QString own = QAccessibleWidget::text(which);
        const Spoken* const spoken = spokenOf(object());
        if (spoken == nullptr || (which != QAccessible::Value && which != QAccessible::Description)) return own;
        const QString value = spoken->spokenValue();
        return own.isEmpty() ? value : value + ". " + own;
    }
    void* interface_cast(QAccessible::InterfaceType type) override {
        if (type == QAccessible::ValueInterface && number()) return static_cast<QAccessibleValueInterface*>(this);
        return QAccessibleWidget::interface_cast(type);
    }

    QVariant currentValue() const override { return of(&SpokenNumber::now); }
    QVariant minimumValue() const override { return of(&SpokenNumber::least); }
    QVariant maximumValue() const override { return of(&SpokenNumber::most); }
    QVariant minimumStepSize() const override { return of(&SpokenNumber::step); }
    void setCurrentValue(const QVariant& value) override {
        if (const auto all = number(); all && all->set) all->set(std::clamp(value.toDouble(), all->least, all->most));
    }

private:
    std::optional<SpokenNumber> number() const {
        Spoken* const spoken = spokenOf(object());
        return spoken == nullptr ? std::nullopt : spoken->spokenNumber();
    }
    QVariant of(double SpokenNumber::*which) const {
        const auto all = number();
        return all ? QVariant((*all).*which) : QVariant();
    }
};

} // namespace

class Spoken::Watch : public QObject {
public:
    explicit Watch(QWidget& widget) : QObject(&widget), m_widget(widget) {
        m_rest.setSingleShot(true);
        m_rest.setInterval(kRest);
        m_rest.callOnTimeout(this, [this] { tell(); });
        widget.installEventFilter(this);
    }
    void wake() {
        if (QAccessible::isActive()) m_rest.start();
    }
    bool eventFilter(QObject*, QEvent* event) override {
        if (event->type() == QEvent::Paint) wake();
        return false;
    }

private:
    void tell() {
        Spoken* const spoken = spokenOf(&m_widget);
        if (spoken == nullptr) return;
        const QString said = std::exchange(m_said, spoken->spokenValue());
        if (said.isEmpty() || said == m_said) return; // what is seen first is no change
        if (const auto number = spoken->spokenNumber()) {
            QAccessibleValueChangeEvent changed(&m_widget, number->now);
            QAccessible::updateAccessibility(&changed);
        }
        QAccessibleEvent described(&m_widget, QAccessible::DescriptionChanged);
        QAccessible::updateAccessibility(&described);
    }

    QWidget& m_widget;
    QTimer m_rest;
    QString m_said;
};

Spoken::Spoken(QWidget& self, QAccessible::Role role) : m_role(role), m_watch(new Watch(self)) {
    QAccessible::installFactory(&Spoken::interfaceOf); // it is installed once, however often
}

void Spoken::speakLater() { m_watch->wake(); }

QAccessibleInterface* Spoken::interfaceOf(const QString&, QObject* object) {
    const Spoken* const spoken = spokenOf(object);
    return spoken == nullptr ? nullptr : new SpokenInterface(static_cast<QWidget*>(object), spoken->m_role);
}

} // namespace pellucid::gui
