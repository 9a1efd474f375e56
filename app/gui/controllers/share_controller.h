// Web pages of what the window shows.
#pragma once

#include <QObject>

#include "jobs/background_work.h"

namespace pellucid {
struct SharedPage;
struct ShareTask;
} // namespace pellucid

namespace pellucid::gui {

class Services;

class ShareController : public FileWork<ShareTask, SharedPage> {
    Q_OBJECT
public:
    explicit ShareController(Services& services);
    ~ShareController() override;

    void addActions();

Q_SIGNALS:
    void saved(const QString& path);

private:
    void choose();
    void tell(const ShareTask& task, const SharedPage& page);

    Services& m_services;
};

} // namespace pellucid::gui
