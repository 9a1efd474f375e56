// Figures for print from the window: what the dialog offers, how it shows them, and what comes of it.
#include "gui_support.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QTimer>

#include "dialogs/figure_dialog.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

/// Answers the dialog once it is open.
void withDialog(const std::function<void(FigureDialog&)>& answer) {
    QTimer::singleShot(0, [answer] {
        for (QWidget* widget : QApplication::topLevelWidgets())
            if (auto* dialog = qobject_cast<FigureDialog*>(widget)) return answer(*dialog);
    });
}

FigureOptions offeredOptions() {
    FigureOptions offered;
    offered.settings.heightMm = 34; // 2/5 of 85 mm
    offered.path = "figure.pdf";
    return offered;
}

} // namespace

TEST_CASE("the figure's dialog has the widths of journals, and keeps the picture's shape", "[figure]") {
    FigureDialog dialog(offeredOptions());
    auto& width = *dialog.findChild<QDoubleSpinBox*>("figureWidth");
    auto& preset = *dialog.findChild<QComboBox*>("figurePreset");
    CHECK(dialog.options().settings == offeredOptions().settings);
    CHECK(preset.currentText().contains("85 mm"));
    preset.setCurrentIndex(2);
    Q_EMIT preset.activated(2);
    CHECK(width.value() == 174);
    CHECK(dialog.findChild<QDoubleSpinBox*>("figureHeight")->value() == Approx(69.6)); // 2/5 of 174
    width.setValue(100);
    CHECK(preset.currentIndex() == preset.count() - 1); // another width
    CHECK(dialog.options().settings.widthMm == 100);
    CHECK(*dialog.options().settings.heightMm == Approx(40));
}

TEST_CASE("what is chosen in the figure's dialog is what the figure has", "[figure]") {
    FigureDialog dialog(offeredOptions());
    QSignalSpy changed(&dialog, &FigureDialog::changed);
    dialog.findChild<QCheckBox*>("figurePart_caption")->setChecked(true);
    dialog.findChild<QCheckBox*>("figurePart_scale")->setChecked(false);
    dialog.findChild<QSpinBox*>("figureDpi")->setValue(600);
    dialog.findChild<QDoubleSpinBox*>("figureFont")->setValue(9);
    dialog.findChild<QLineEdit*>("figureTitle")->setText(" Skull ");
    CHECK(changed.count() == 5);
    const FigureSettings settings = dialog.options().settings;
    CHECK(figurePartsOf(settings.parts) ==
          FigureParts{.letters = true, .legend = true, .shares = true, .caption = true});
    CHECK(settings.dpi == 600);
    CHECK(settings.fontPt == 9);
    CHECK(settings.title == "Skull");
    auto& path = *dialog.findChild<QLineEdit*>("figurePath");
    const auto& save = *dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save);
    path.setText("skull");
    CHECK(dialog.options().path == "skull.pdf");
    path.setText("skull.SVG");
    CHECK(dialog.options().path == "skull.SVG");
    path.setText(" ");
    CHECK_FALSE(save.isEnabled());
}

TEST_CASE("a figure of the window is shown before it is written, and written in the background", "[figure]") {
    const QTemporaryDir folder;
    OpenWindow w(16);
    FigureController& figures = w.controllers().figures;
    QSignalSpy saved(&figures, &FigureController::saved);
    const QString path = folder.filePath("figure.svg");
    bool shown = false;
    withDialog([&](FigureDialog& dialog) {
        auto& preview = *dialog.findChild<QLabel*>("figurePreview");
        shown = waitFor([&] { return !preview.pixmap().isNull(); });
        dialog.findChild<QSpinBox*>("figureDpi")->setValue(60);
        dialog.findChild<QLineEdit*>("figurePath")->setText(path);
        dialog.accept();
    });
    w.child<QAction>("saveFigureAction").trigger();
    CHECK(shown);
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
    QFile file(path);
    REQUIRE(file.open(QIODevice::ReadOnly));
    const QByteArray svg = file.readAll();
    CHECK(svg.contains("<svg"));
    CHECK(svg.contains("width=\"85mm\""));
    CHECK(svg.contains("id=\"feature-1\""));
}
