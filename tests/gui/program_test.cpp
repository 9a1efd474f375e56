// The program itself, as it is started from a shell.
#include "gui_support.h"

#include <fstream>

#include <QFile>
#include <QProcess>
#include <QRegularExpression>
#include <QSet>
#include <QTemporaryDir>

#include "session/session_json.h"

using namespace pellucid;
using namespace pellucid::gui;

namespace {

struct Outcome {
    int status = -1;
    QString out, err;
};

Outcome start(const QStringList& arguments, bool display = true) {
    const QTemporaryDir settings;
    QProcess process;
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    environment.insert("XDG_CONFIG_HOME", settings.path());
    if (!display) {
        for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) environment.remove(name);
    }
    process.setProcessEnvironment(environment);
    process.start(PELLUCID_PROGRAM, arguments);
    REQUIRE(process.waitForFinished(kPatience));
    REQUIRE(process.exitStatus() == QProcess::NormalExit);
    return {process.exitCode(), QString::fromUtf8(process.readAllStandardOutput()),
            QString::fromUtf8(process.readAllStandardError())};
}

} // namespace

TEST_CASE("a screenshot shows the window with picture and figures", "[program]") {
    const QTemporaryDir folder;
    const QString path = folder.filePath("window.png");
    const Outcome run = start({"sample:disks", "--tf", "tents:2", "--size", "1000x700", "--screenshot", path});
    INFO(run.err.toStdString());
    REQUIRE(run.status == 0);
    const QImage image(path);
    CHECK(image.height() == 700);
    CHECK(image.width() >= 1000); // or the least that the docks need
    QSet<QRgb> colors;
    for (int x = 0; x < image.width() / 2; x += 2) {
        for (int y = 100; y < image.height() / 2; y += 2) colors.insert(image.pixel(x, y));
    }
    CHECK(colors.size() > 10); // the view, in the upper left part, is not empty
}

TEST_CASE("without a file it opens on the knee", "[program]") {
    const QTemporaryDir folder;
    const auto picture = [&](const QStringList& what) {
        const QString path = folder.filePath("window.png");
        const Outcome run = start(QStringList{"--size", "1000x700", "--renderer", "cpu", "--screenshot", path} + what);
        INFO(run.err.toStdString());
        REQUIRE(run.status == 0);
        return QImage(path);
    };
    CHECK(picture({}) == picture({"sample:knee"}));
    CHECK(start({"--help"}, false).out.contains("sample:knee"));
}

TEST_CASE("the manual has the options of --help, in the same words", "[program]") {
    QFile file(PELLUCID_SOURCE_DIR "/docs/man/pellucid.1");
    REQUIRE(file.open(QIODevice::ReadOnly));
    const QString manual = QString::fromUtf8(file.readAll()).remove('\\');
    const QString options = manual.section(".SH OPTIONS\n", 1).section(".SH ", 0, 0);
    const Outcome help = start({"--help"}, false);
    REQUIRE(help.status == 0);
    // Of a help that breaks lines at blanks, without the brackets: "--tf <SPEC>  Transfer function: …".
    const QString said = QString(help.out).remove('<').remove('>').simplified();
    QSet<QString> inManual, inHelp;
    for (const QString& entry : options.split(".TP\n", Qt::SkipEmptyParts)) {
        static const QRegularExpression kHead("^\\.BI? (--[a-z]+)(?: \" ([A-Za-z]+)\")?\n");
        const QRegularExpressionMatch head = kHead.match(entry);
        if (!head.hasMatch()) continue; // of Qt: help and version
        INFO(entry.toStdString());
        inManual << head.captured(1);
        CHECK(said.contains(
            (head.captured(1) + " " + head.captured(2) + " " + entry.mid(head.capturedLength())).simplified()));
    }
    static const QRegularExpression kOption("^  (--[a-z-]+)", QRegularExpression::MultilineOption);
    for (auto match = kOption.globalMatch(help.out); match.hasNext();) inHelp << match.next().captured(1);
    inHelp.remove("--help-all");
    CHECK(inManual.size() >= 9);
    CHECK(inManual == inHelp);
}

TEST_CASE("a theme can be named", "[program][theme]") {
    const QTemporaryDir folder;
    const auto corner = [&](const QStringList& options) { // the middle of the menu bar
        const QString path = folder.filePath("window.png");
        const Outcome run = start(QStringList{"sample:disks", "--size", "1000x700", "--screenshot", path} + options);
        INFO(run.err.toStdString());
        REQUIRE(run.status == 0);
        const QImage image(path);
        return qGray(image.pixel(image.width() / 2, 8));
    };
    CHECK(corner({}) < 80);
    CHECK(corner({"--theme", "dark"}) < 80);
    CHECK(corner({"--theme", "light"}) > 200);
    const Outcome wrong = start({"--theme", "pink"});
    CHECK(wrong.status == 2);
    CHECK(wrong.err.contains("no theme \"pink\""));
}

TEST_CASE("help and version need no display, a window does", "[program]") {
    const Outcome help = start({"--help"}, false);
    CHECK(help.status == 0);
    CHECK(help.out.contains("--screenshot"));
    CHECK(start({"--version"}, false).out.startsWith("pellucid "));
    const Outcome window = start({}, false);
    CHECK(window.status == 1);
    CHECK(window.err.startsWith("pellucid: error: no display"));
    CHECK(window.err.count('\n') == 1);
}

TEST_CASE("wrong usage is told in one line, with status 2", "[program]") {
    for (const QStringList& arguments :
         {QStringList{"--nonsense"}, {"--size", "12"}, {"--renderer", "pencil"}, {"a.tf.json", "b.tf.json"}}) {
        const Outcome run = start(arguments);
        INFO(arguments.join(' ').toStdString() << ": " << run.err.toStdString());
        CHECK(run.status == 2);
        CHECK(run.err.contains("pellucid: error: "));
    }
}

TEST_CASE("a transfer function that cannot be read ends a screenshot with status 1", "[program]") {
    const QTemporaryDir folder;
    const Outcome run =
        start({"sample:disks", "--tf", "/nonexistent/a.tf.json", "--screenshot", folder.filePath("a.png")});
    CHECK(run.status == 1);
    CHECK(run.err.contains("pellucid: error: no such file"));
    CHECK_FALSE(QFile::exists(folder.filePath("a.png")));
}

TEST_CASE("a screenshot asks for none of several transfer functions in a file", "[program]") {
    const QTemporaryDir folder;
    QFile file(folder.filePath("several.json"));
    REQUIRE(file.open(QIODevice::WriteOnly));
    file.write(R"([{"Name": "a", "RGBPoints": [0, 1, 0, 0, 1, 1, 0, 0], "Points": [0, 0.2, 0.5, 0, 1, 0.6, 0.5, 0]},
                   {"Name": "b", "RGBPoints": [0, 0, 1, 0, 1, 0, 1, 0], "Points": [0, 0.2, 0.5, 0, 1, 0.6, 0.5, 0]}])");
    file.close();
    const Outcome run = start(
        {"sample:disks", "--tf", file.fileName(), "--screenshot", folder.filePath("a.png")}); // it comes to its end
    INFO(run.err.toStdString());
    CHECK(run.status == 0);
    CHECK(QFile::exists(folder.filePath("a.png")));
}

TEST_CASE("a session is opened from a shell", "[program]") {
    const QTemporaryDir folder;
    const QString session = folder.filePath("s.pellucid.json"), picture = folder.filePath("a.png");
    SceneInputs inputs;
    VolumeSource source;
    source.path = "sample:disks";
    source.sampleSize = 20;
    inputs.session = sessionOf(source);
    writeSession(openScene(inputs).session, session.toStdString());
    const Outcome run = start({"--session", session, "--screenshot", picture});
    INFO(run.err.toStdString());
    CHECK(run.status == 0);
    CHECK(QFile::exists(picture));
    CHECK(start({"--session", folder.filePath("none.pellucid.json"), "--screenshot", picture}).status == 1);
    std::ofstream(session.toStdString()) << R"({"format":"pellucid-session","version":99,"variables":[]})";
    const Outcome newer = start({session, "--screenshot", picture});
    CHECK(newer.status == 1);
    CHECK(newer.err.contains("newer than this program knows"));
}

TEST_CASE("a volume that cannot be opened ends a screenshot with status 1", "[program]") {
    const QTemporaryDir folder;
    const Outcome run = start({"/nonexistent/a.nrrd", "--screenshot", folder.filePath("a.png")});
    CHECK(run.status == 1);
    CHECK_FALSE(QFile::exists(folder.filePath("a.png")));
}
