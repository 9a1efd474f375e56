// pellucid: the window.
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include <QApplication>
#include <QCommandLineParser>

#include "controllers/controllers.h"
#include "controllers/menu_actions.h"
#include "window/main_window.h"
#include "tf/formats/tf_file.h"
#include "version.h"
#include "widgets/input_habits.h"
#include "widgets/theme.h"

namespace {

using namespace pellucid;
using namespace pellucid::gui;

constexpr int kFailed = 1, kUsage = 2; // as the command line promises

int complain(const QString& message, int status) {
    std::fprintf(stderr, "pellucid: error: %s\n", qPrintable(message));
    return status;
}

// Qt ends the process with an abort where it finds no display; better to say so before.
bool displayMissing() {
#ifdef Q_OS_LINUX
    return qEnvironmentVariableIsEmpty("DISPLAY") && qEnvironmentVariableIsEmpty("WAYLAND_DISPLAY") &&
           qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM");
#else
    return false;
#endif
}

bool has(int argc, char** argv, std::initializer_list<const char*> options) {
    for (int i = 1; i < argc; ++i) {
        for (const char* option : options) {
            if (std::strcmp(argv[i], option) == 0) return true;
        }
    }
    return false;
}

void describe(QCommandLineParser& parser) {
    parser.setApplicationDescription(
        "Shows volumes, measures what catches the eye in them, and finds transfer functions.\n"
        "Without a FILE it opens on the built-in volume sample:knee.");
    parser.addPositionalArgument(
        "FILE",
        "a volume, or the frames of a series: files, a folder, a pattern (\"f%02d.mhd\", \"f*.mhd\"); sessions and "
        "samples, a window each: *.pellucid.json, sample:NAME",
        "[FILE…]");
    parser.addOption({"tf",
                      "Transfer function: a *.tf.json or Voreen *.tfi file, auto (what the data propose, the default), "
                      "tents:N[:PEAK], "
                      "ramp:N or preset:NAME.",
                      "SPEC"});
    parser.addOption({"session", "Go on with a saved session, a *.pellucid.json file.", "FILE"});
    parser.addOption({"windows", "Each FILE in a window of its own, not as frames of one series."});
    parser.addOption({"renderer", "What draws the picture: auto, gl or cpu.", "NAME", "auto"});
    parser.addOption({"theme", "Colours of the window: dark, light or system; without it, as chosen last.", "NAME"});
    parser.addOption({"size", "Size of the window in pixels.", "WxH"});
    parser.addOption(
        {"screenshot", "Wait until picture and figures are complete, save the window as PNG FILE, and quit.", "FILE"});
    parser.addHelpOption();
    parser.addVersionOption();
}

/// What each window opens: a session, a sample, or files that are the frames of a series.
QList<QStringList> documentsOf(const QStringList& names, bool windowEach) {
    QList<QStringList> documents;
    QStringList frames;
    for (const QString& name : names) {
        if (windowEach || name.startsWith("sample:") || name.endsWith(".pellucid.json", Qt::CaseInsensitive))
            documents << QStringList{name};
        else
            frames << name;
    }
    if (!frames.isEmpty()) documents << frames;
    return documents;
}

} // namespace

int main(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN); // a limit on file sizes is an error of writing, not the end of the program
    QCoreApplication::setApplicationName("pellucid");
    QCoreApplication::setOrganizationName("pellucid");
    QCoreApplication::setApplicationVersion(kVersion);
    QCommandLineParser parser;
    describe(parser);
    if (has(argc, argv, {"--help", "-h", "--help-all", "--version", "-v"})) { // must work without a display
        const QCoreApplication application(argc, argv);
        parser.process(application);
        return 0;
    }
    if (displayMissing())
        return complain("no display, DISPLAY and WAYLAND_DISPLAY are not set, use pellucid-cli, or xvfb-run pellucid",
                        kFailed);

    // Qt takes "--session ID" for itself, but not "--session=FILE".
    std::vector<std::string> words;
    for (int i = 0; i < argc; ++i) {
        words.emplace_back(argv[i]);
        if ((words.back() == "--session" || words.back() == "-session") && i + 1 < argc)
            words.back() = std::string("--session=") + argv[++i];
    }
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    int count = static_cast<int>(arguments.size());
    arguments.push_back(nullptr);
    QApplication application(count, arguments.data());
    InputHabits habits;
    application.installEventFilter(&habits);
    if (!parser.parse(QApplication::arguments()))
        return complain("wrong option, " + parser.errorText().chopped(1) + ", see pellucid --help", kUsage);

    const QString screenshot = parser.value("screenshot");
    // A picture is the same on every machine.
    Theme theme = screenshot.isEmpty() ? keptTheme() : Theme::Dark;
    if (parser.isSet("theme")) {
        const auto named = findNamed<Theme>(parser.value("theme").toStdString());
        if (!named)
            return complain("no theme \"" + parser.value("theme") + "\", --theme, use dark, light or system", kUsage);
        theme = *named;
    }
    applyTheme(application, theme);

    const QString rendererName = parser.value("renderer");
    ViewRenderer renderer = ViewRenderer::Auto;
    if (rendererName == "gl") {
        renderer = ViewRenderer::Gl;
    } else if (rendererName == "cpu") {
        renderer = ViewRenderer::Cpu;
    } else if (rendererName != "auto") {
        return complain("no renderer \"" + rendererName + "\", --renderer, use auto, gl or cpu", kUsage);
    }
    QSize size;
    if (parser.isSet("size")) {
        const QStringList parts = parser.value("size").split('x');
        if (parts.size() == 2) size = {parts[0].toInt(), parts[1].toInt()};
        if (size.width() < 1 || size.height() < 1)
            return complain("bad size \"" + parser.value("size") + "\", --size, write it as 1280x800", kUsage);
    }

    QString tf = parser.value("tf");
    QStringList volumes;
    for (const QString& file : parser.positionalArguments()) {
        if (hasTfSuffix(file.toStdString())) {
            if (!tf.isEmpty()) return complain("more than one transfer function, " + file + ", give one", kUsage);
            tf = file;
        } else {
            volumes << file;
        }
    }
    if (parser.isSet("session")) volumes.prepend(parser.value("session"));
    const bool onSample = volumes.isEmpty();
    if (onSample) volumes << "sample:knee";
    const QList<QStringList> documents = documentsOf(volumes, parser.isSet("windows"));
    if (!screenshot.isEmpty() && documents.size() > 1)
        return complain("--screenshot takes one window, " + volumes.join(" ") + ", give one FILE", kUsage);

    try {
        std::vector<std::unique_ptr<MainWindow>> windows;
        for (const QStringList& files : documents) {
            windows.push_back(std::make_unique<MainWindow>(renderer));
            MainWindow& window = *windows.back();
            if (screenshot.isEmpty()) window.restoreLayout();
            if (!size.isEmpty()) window.resize(size);
            window.show();
            OpenController& opening = window.controllers().opening;
            if (screenshot.isEmpty()) {
                window.controllers().recovery.start();
                if (onSample) window.welcome();
                if (windows.size() == 1) window.controllers().recovery.offerWhenOpen();
            } else {
                QObject::connect(
                    &window, &MainWindow::settledChanged, &window,
                    [&window, screenshot] {
                        if (!window.isSettled()) return;
                        // Texts have come that nothing has made room for yet.
                        QApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest);
                        if (!window.grab().save(screenshot, "PNG"))
                            return QCoreApplication::exit(complain("cannot write the picture, " + screenshot +
                                                                       ", choose a folder you can write to",
                                                                   kFailed));
                        QCoreApplication::exit(0);
                    },
                    Qt::QueuedConnection);
                const auto fail = [](const Error& error) {
                    QCoreApplication::exit(complain(QString::fromUtf8(error.what()), kFailed));
                };
                QObject::connect(&opening, &OpenController::failed, &window, fail, Qt::QueuedConnection);
                QObject::connect(&opening, &OpenController::tfFailed, &window, fail, Qt::QueuedConnection);
            }
            opening.openAtStart(files, tf);
        }
        return QApplication::exec();
    } catch (const Error& error) {
        return complain(QString::fromUtf8(error.what()), kFailed);
    }
}
