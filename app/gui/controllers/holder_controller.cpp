#include "controllers/holder_controller.h"

#include <algorithm>

#include "controllers/open_controller.h"
#include "services/services.h"
#include "store/view_edits.h"

namespace pellucid::gui {

HolderController::HolderController(Services& services, OpenController& opening) : m_services(services) {
    connect(&opening, &OpenController::opened, this, [this] {
        if (m_services.scene().proposal) tell(); // who has chosen a transfer function knows his data
    });
    connect(&services.store(), &SessionStore::changed, this, [this] {
        m_known.of(m_services.scene());
        if (isTold()) say();
    });
}

bool HolderController::isTold() const {
    return !m_said.isEmpty() && std::ranges::count(m_services.notices().all(), m_said, &Notice::text) > 0;
}

void HolderController::tell() {
    m_said.clear();
    say();
}

void HolderController::say() {
    const FaintRest& rest = m_services.scene().session.clipping->rest;
    Notice notice;
    const auto offer = [&](const QString& text, const QString& step,
                           void (*change)(FaintRest & rest, const FaintRest& known)) {
        notice.choices.push_back({text, [this, step, change] { draw(step, change); }});
    };
    const auto offerFully = [&] {
        offer(tr("Show board fully"), tr("Show the holder"), [](FaintRest& r, const FaintRest&) { r = {}; });
    };
    if (m_known.of(m_services.scene()).isNone()) {
        notice = {};
    } else if (rest.isNone()) {
        notice.text = tr("The board or holder is drawn and measured like the rest.");
        offer(tr("Draw it faintly"), tr("Draw the holder faintly"),
              [](FaintRest& r, const FaintRest& known) { r = known; });
    } else if (rest.density == 0) {
        notice.text = tr("The board or holder is left out: it is neither drawn nor measured.");
        offerFully();
    } else {
        notice.text = tr("The object lies on a board or holder, which is drawn faintly and not measured.");
        offer(tr("Leave out board"), tr("Leave out the holder"), [](FaintRest& r, const FaintRest&) { r.density = 0; });
        offerFully();
    }
    if (notice.text == m_said) return;
    if (!m_said.isEmpty()) m_services.notices().remove(m_said);
    m_said = notice.text;
    if (!m_said.isEmpty()) m_services.notices().add(std::move(notice));
}

void HolderController::draw(const QString& step, void (*change)(FaintRest& rest, const FaintRest& known)) {
    if (m_services.isEditable()) {
        const FaintRest known = m_known.of(m_services.scene());
        m_services.store().edit(step, {}, [&](Session& session) {
            session.clipping.edit([&](Clipping& clipping) { change(clipping.rest, known); });
        });
        fitView(m_services.store());
    }
    tell(); // the note has gone with the click
}

} // namespace pellucid::gui
