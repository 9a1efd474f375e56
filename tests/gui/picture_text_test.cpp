// What pictures that the window saves say of themselves, the way back to their session, and their layers.
#include "gui_support.h"

#include <map>

#include <QCheckBox>
#include <QComboBox>
#include <QLineEdit>
#include <QProcess>
#include <QSettings>
#include <QSignalSpy>
#include <QTemporaryDir>

#include "dialogs/save_image_dialog.h"
#include "image_io/image_file.h"
#include "image_io/png_text.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

void save(OpenWindow& w, const SaveImageOptions& options) {
    QSignalSpy saved(&w.saving(), &SaveController::imageSaved);
    w.saving().saveImage(options);
    REQUIRE(waitFor([&] { return saved.count() == 1; }));
}

std::map<std::string, std::string> textsOf(const QString& path) {
    std::map<std::string, std::string> texts;
    for (const PngText& text : readPngTexts(path.toStdString())) texts[text.keyword] = text.text;
    return texts;
}

} // namespace

TEST_CASE("a saved picture opens again as the session that it shows", "[picture-text]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    const QTemporaryDir folder;
    const QString path = folder.filePath("it's.png"), plain = folder.filePath("plain.png");
    w.document().setCamera(cameraFromView(w.document().volume()->geometry(), 70, 10, 1, Projection::Perspective));
    w.settle();
    const Session shown = w.services().scene().session;
    save(w, {path, {96, 64}, true, false});
    const auto texts = textsOf(path);
    CHECK(texts.at("Software").starts_with("Pellucid "));
    CHECK(texts.at("Description").find('%') != std::string::npos); // measured shares: the window has them
    CHECK(texts.at("pellucid:command") ==
          "pellucid-cli render --session 'it'\\''s.png' --size 96x64 --background transparent --out picture.png");
    save(w, {plain, {96, 64}, true, false, false, false});
    CHECK(textsOf(plain).empty());
    CHECK(readImage(plain.toStdString()).rgba == readImage(path.toStdString()).rgba);

    // As it says, word for word, by a shell in its folder.
    QProcess shell;
    shell.setWorkingDirectory(folder.path());
    const QString command = QString::fromStdString(texts.at("pellucid:command")).mid(12); // without "pellucid-cli"
    shell.start("sh", {"-c", QStringLiteral(PELLUCID_CLI_PROGRAM) + command});
    REQUIRE(shell.waitForFinished(kPatience));
    INFO(shell.readAllStandardError().toStdString());
    REQUIRE(shell.exitCode() == 0);
    CHECK(readImage(folder.filePath("picture.png").toStdString()).rgba == readImage(path.toStdString()).rgba);

    w.document().setCamera(cameraFromView(w.document().volume()->geometry(), 0, 0, 1, Projection::Perspective));
    w.settle();
    w.services().store().setClean();
    QSignalSpy opened(&w.opening(), &OpenController::opened);
    w.opening().openPath(path);
    REQUIRE(waitFor([&] { return opened.count() == 1; }));
    w.settle();
    CHECK(*w.services().scene().session.tf() == *shown.tf());
    CHECK(w.services().scene().camera == *shown.camera);
    CHECK(w.saving().sessionPath().isEmpty()); // Save session asks for a name, and leaves the picture alone
}

TEST_CASE("the dialog for pictures offers their layers, and remembers whether files say what they show",
          "[picture-text]") {
    QSettings().remove("describePictures");
    SaveImageDialog dialog("/tmp/knee.png", {400, 300}, true, true);
    CHECK(dialog.options().described);
    CHECK_FALSE(dialog.options().layers);
    auto* content = dialog.findChild<QComboBox*>("imageContent");
    auto* path = dialog.findChild<QLineEdit*>("imagePath");
    REQUIRE(content->count() == 3);
    const auto choose = [&](int index) {
        content->setCurrentIndex(index);
        Q_EMIT content->activated(index);
    };
    choose(1);
    CHECK(dialog.options().layers);
    CHECK(path->text() == "/tmp/knee.exr");
    CHECK_FALSE(dialog.findChild<QCheckBox*>("imageTransparent")->isEnabled());
    CHECK_FALSE(dialog.findChild<QCheckBox*>("imageReference")->isEnabled());
    choose(2);
    CHECK(path->text() == "/tmp/knee_layers");
    choose(0);
    CHECK(path->text() == "/tmp/knee.png");
    CHECK(dialog.findChild<QCheckBox*>("imageReference")->isEnabled());
    dialog.findChild<QCheckBox*>("imageDescribed")->click();
    CHECK_FALSE(SaveImageDialog("a.png", {4, 3}, true, true).options().described);
    QSettings().remove("describePictures");
    CHECK_FALSE(SaveImageDialog("a.png", {4, 3}, true, false).findChild<QComboBox*>("imageContent")->isEnabled());
}

TEST_CASE("the window saves the layers of its picture", "[picture-text]") {
    OpenWindow w(24, ViewRenderer::Cpu);
    const QTemporaryDir folder;
    const QString file = folder.filePath("l.exr"), pictures = folder.filePath("layers");
    for (const QString& path : {file, pictures}) save(w, {path, {48, 40}, false, false, true});
    save(w, {folder.filePath("p.exr"), {48, 40}, true});
    const Image picture = readImage(folder.filePath("p.exr").toStdString()), layers = readImage(file.toStdString());
    double most = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(picture.rgba[i]) - layers.rgba[i]));
    CHECK(most < 2.5 / 255); // which renderer draws the picture here is chosen by how fast it is
    CHECK(QFileInfo(pictures + "/layers.json").exists());

    const auto errors = [&] { return w.window.findChildren<QDialog*>("errorDialog").size(); };
    w.saving().saveImage({folder.filePath("l.png"), {48, 40}, false, false, true});
    CHECK(errors() == 1);
    // A folder that is none of layers is not replaced.
    QDir(folder.path()).mkdir("mine");
    w.saving().saveImage({folder.filePath("mine"), {48, 40}, false, false, true});
    CHECK(waitFor([&] { return errors() == 2; }));
    for (QDialog* dialog : w.window.findChildren<QDialog*>("errorDialog")) dialog->accept();
    CHECK(QDir(folder.filePath("mine")).isEmpty());
}
