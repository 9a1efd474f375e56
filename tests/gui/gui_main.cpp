// Catch's main with a QApplication around it. Listing the tests, which the build does, must work without a display.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include <cstdio>
#include <string_view>

#include <QApplication>
#include <QSettings>
#include <QStandardPaths>
#include <QTemporaryDir>

#include "play_study.h"
#include "widgets/theme.h"

int main(int argc, char** argv) {
    if (argc == 4 && std::string_view(argv[1]) == pellucid::gui::kPlayStudy) {
        const QApplication application(argc, argv);
        return pellucid::gui::playStudy(argv[2], argv[3]);
    }
    Catch::Session session;
    if (const int wrong = session.applyCommandLine(argc, argv); wrong != 0) return wrong;
    const Catch::ConfigData& data = session.configData();
    if (data.listTests || data.listTestNamesOnly || data.listTags || data.listReporters || data.showHelp)
        return session.run();
    if (qEnvironmentVariableIsEmpty("DISPLAY") && qEnvironmentVariableIsEmpty("WAYLAND_DISPLAY")) {
        std::fprintf(stderr, "SKIPPED: no display; run ctest under xvfb-run\n");
        return 77; // SKIP_RETURN_CODE
    }
    QApplication application(argc, argv);
    // The settings and the cache of whoever runs the tests stay theirs, but for the drivers' own cache.
    const QTemporaryDir settings, cache;
    if (qEnvironmentVariableIsEmpty("MESA_SHADER_CACHE_DIR"))
        qputenv("MESA_SHADER_CACHE_DIR",
                QStandardPaths::writableLocation(QStandardPaths::GenericCacheLocation).toUtf8());
    qputenv("XDG_CACHE_HOME", cache.path().toUtf8());
    QSettings::setDefaultFormat(QSettings::IniFormat);
    QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
    QCoreApplication::setOrganizationName("pellucid-test");
    QCoreApplication::setApplicationName("pellucid-test");
    pellucid::gui::applyTheme(application);
    return session.run();
}
