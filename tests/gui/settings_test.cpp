// Rows that are bound to descriptions of settings: the window as a door to every setting that it has.
#include "gui_support.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QPushButton>
#include <QSlider>
#include <QSpinBox>
#include <QToolButton>

#include "panels/setting_rows.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// What the control shows becomes another value, within its ends. What cannot be set so is left.
void change(QWidget& control) {
    if (auto* box = qobject_cast<QDoubleSpinBox*>(&control))
        box->setValue(box->value() > (box->minimum() + 1) / 2 ? box->minimum() : std::min(1.0, box->maximum()));
    else if (auto* whole = qobject_cast<QSpinBox*>(&control))
        whole->setValue(whole->value() == 7 ? 8 : 7);
    else if (auto* check = qobject_cast<QCheckBox*>(&control))
        Q_EMIT check->clicked(!check->isChecked());
    else if (auto* combo = qobject_cast<QComboBox*>(&control)) {
        combo->setCurrentIndex((combo->currentIndex() + 1) % combo->count());
        Q_EMIT combo->activated(combo->currentIndex());
    }
}

} // namespace

TEST_CASE("every row sets its setting within its range, and undo takes it back", "[settings]") {
    OpenWindow w;
    w.settle();
    int rows = 0;
    for (SettingRows* group : w.window.findChildren<SettingRows*>())
        for (const auto& [setting, control] : group->rows()) {
            const QString id = control->objectName();
            INFO(id.toStdString());
            CHECK_FALSE(id.isEmpty());
            CHECK(control->toolTip().startsWith(QString::fromUtf8(setting->help).left(20)));
            // Those that need data that is not there, and those that ask for a colour.
            if (id.startsWith("ground") || id.startsWith("hsb") || qobject_cast<QPushButton*>(control)) continue;
            ++rows;
            const std::string before = textOf(*setting, group->present());
            change(*control);
            CHECK(textOf(*setting, group->present()) != before);
            CHECK_NOTHROW(check(*setting, group->present()));
            w.document().undo();
            if (id.startsWith("compare")) { // how states are compared is no step, as the camera is none
                CHECK(textOf(*setting, group->present()) != before);
                for (int turns = 0; turns < 4 && textOf(*setting, group->present()) != before; ++turns)
                    change(*control);
                continue;
            }
            CHECK(textOf(*setting, group->present()) == before);
            auto* box = qobject_cast<QDoubleSpinBox*>(control);
            if (box == nullptr) continue;
            for (const double end : {box->minimum(), box->maximum()}) {
                box->setValue(end);
                CHECK_NOTHROW(check(*setting, group->present()));
            }
            for (int steps = 0; steps < 2 && textOf(*setting, group->present()) != before; ++steps) w.document().undo();
            CHECK(textOf(*setting, group->present()) == before);
        }
    CHECK(rows >= 20);
}

TEST_CASE("a number that need not be there is switched on and off", "[settings]") {
    OpenWindow w;
    auto& box = w.child<QDoubleSpinBox>("coverageSpin");
    auto& automatic = w.child<QToolButton>("coverageSpinAutomatic");
    const auto coverage = [&] { return w.services().store().session().optimize->coverage; };
    CHECK(automatic.isChecked());
    box.setValue(0.4);
    CHECK(coverage() == 0.4);
    CHECK_FALSE(automatic.isChecked());
    automatic.click();
    CHECK_FALSE(coverage().has_value());
    const double shown = box.value(); // what the picture has, or a usual one
    CHECK(shown > 0);
    automatic.click();
    CHECK(*coverage() == Approx(shown).margin(0.0005)); // the box rounds
}

TEST_CASE("small numbers of a session are shown as they are", "[settings]") {
    OpenWindow w;
    w.services().store().edit("Tolerance", {},
                              [](Session& s) { s.optimize.edit([](OptimizeOptions& o) { o.tolerance = 0.0005; }); });
    CHECK(w.child<QDoubleSpinBox>("toleranceSpin").value() == 0.0005);
    CHECK(w.child<QDoubleSpinBox>("toleranceSpin").text() == "0.0005");
    CHECK(w.services().store().session().optimize->tolerance == 0.0005);
}

TEST_CASE("where nothing is seen, the coverage that is set is one that a session may have", "[settings]") {
    OpenWindow w;
    const TransferFunction& tf = w.document().tf();
    w.document().setTf(withFeatureOpacities(tf, std::vector<double>(tf.features.size(), 0)), "hide");
    w.settle();
    REQUIRE(w.document().measures()->coverage->coverage == 0);
    w.child<QToolButton>("coverageSpinAutomatic").click();
    const OptimizeOptions options = *w.services().store().session().optimize;
    REQUIRE(options.coverage.has_value());
    CHECK(*options.coverage > 0);
    CHECK_NOTHROW(checkSettings(options, "optimize"));
}

TEST_CASE("a click on a slider that does not move it keeps the number", "[settings]") {
    OpenWindow w;
    w.services().store().edit("Threshold", {},
                              [](Session& s) { s.field.edit([](FieldView& f) { f.threshold = 0.1234; }); });
    int sliders = 0;
    for (QSlider* slider : w.window.findChildren<QSlider*>()) {
        if (!slider->objectName().startsWith("field")) continue;
        ++sliders;
        INFO(slider->objectName().toStdString());
        const Session before = w.services().store().session();
        slider->setSliderDown(true);
        slider->setSliderDown(false);
        CHECK(w.services().store().session() == before);
    }
    CHECK(sliders == 2);
}
