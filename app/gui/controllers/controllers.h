// All that a window's menus do: the controllers, and how they hear of each other.
#pragma once

#include "controllers/adapt_controller.h"
#include "controllers/comparison_controller.h"
#include "controllers/feature_actions.h"
#include "controllers/field_controller.h"
#include "controllers/figure_controller.h"
#include "controllers/film_controller.h"
#include "controllers/holder_controller.h"
#include "controllers/keyframes_controller.h"
#include "controllers/live_controller.h"
#include "controllers/open_controller.h"
#include "controllers/optimize_controller.h"
#include "controllers/orientation_controller.h"
#include "controllers/overlay_controller.h"
#include "controllers/picture_saliency_controller.h"
#include "controllers/player_controller.h"
#include "controllers/probe_controller.h"
#include "controllers/recovery_controller.h"
#include "controllers/refine_controller.h"
#include "controllers/ruler_controller.h"
#include "controllers/save_controller.h"
#include "controllers/share_controller.h"
#include "controllers/start_controller.h"
#include "controllers/study_controller.h"
#include "controllers/target_actions.h"
#include "controllers/view_search_controller.h"

namespace pellucid::gui {

/// Each controller gets the services, and the controllers that it calls: these are made before it and go after it.
struct Controllers {
    explicit Controllers(Services& services);
    ~Controllers();

    Services& services;
    OptimizeController optimizing{services};
    RefineController refining{services, optimizing};
    FieldController fields{services}; ///< what is drawn in the place of the data
    LiveController live{services, optimizing};
    PictureSaliencyController pictureSaliency{services};
    RulerController rulers{services};
    SaveController saving{services, fields, pictureSaliency, rulers};
    FigureController figures{services};
    FilmController films{services};
    ShareController sharing{services};
    OpenController opening{services, saving};
    OrientationController orientation{services, opening};
    OverlayController overlays{services, opening};
    StartController starting{services, opening};
    HolderController holder{services, opening};
    RecoveryController recovery{services, opening, saving};
    PlayerController player{services, opening}; ///< frames of a series
    AdaptController adapting{services, player}; ///< transfer functions over time
    KeyframesController keyframes{services, player, films};
    ViewSearchController views{services, optimizing};
    ComparisonController comparing{services, player, refining};
    ProbeController probe{services};
    StudyController studies{services};
    TargetActions targets{services};
    FeatureActions features{services, targets};
    QAction* clipHandles = nullptr;
};

} // namespace pellucid::gui
