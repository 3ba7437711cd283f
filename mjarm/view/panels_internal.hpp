#pragma once

#include <mujoco/mujoco.h>

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "mjarm/view/controls.hpp"
#include "mjarm/view/events.hpp"
#include "mjarm/view/settings.hpp"
#include "mjarm/view/ui_column_internal.hpp"

namespace mjarm::view {

/// What the panels tell of the simulation.
struct PanelFacts {
  const mjData* d = nullptr;  ///< the state shown
  bool paused = false;
  double speed = 1;
};

/// The two panels of a window: settings and simulation at the left, joints and the application's
/// own sections at the right. An OpenGL context is current in every call but the constructor.
class Panels {
 public:
  /// @param jog_dofs  dofs of the joints whose sliders work; the others are grey.
  Panels(const mjModel& m, std::vector<int> jog_dofs, bool can_step, bool can_reset);

  /// Puts them into a window of that size [pixels].
  void resize(int width, int height);
  void toggle_left();
  void toggle_right();
  /// The section of joints is folded away when it is shown first.
  void fold_joints() { joints_open_ = false; }
  [[nodiscard]] bool left_shown() const { return left_shown_; }
  [[nodiscard]] bool right_shown() const { return right_shown_; }

  /// Brings what they show up to date.
  void show(const ViewSettings& settings, const PanelFacts& facts,
            std::span<const PanelSection> sections, mjrContext& context);
  void render(const mjrContext& context, GlyphFont& font);

  /// Mouse and place of the picture, `view()`, as MuJoCo keeps them.
  [[nodiscard]] mjuiState& state() { return state_; }
  [[nodiscard]] const mjrRect& view() const { return state_.rect[3]; }
  /// True where the event in `state()` is for a panel.
  [[nodiscard]] bool owns_event() const;
  /// Lets that event act.
  /// @return what the user asked for, a setting being changed in `settings` at once.
  std::optional<std::variant<ViewAction, ViewEvent>> handle(ViewSettings& settings,
                                                            const mjrContext& context);

  /// Place of an item in the window; for tests.
  [[nodiscard]] std::optional<mjrRect> place(bool left, int section, int item) const;

 private:
  struct Joint {
    int dof;
    int qpos;
    std::string name;
    double lower, upper;
    bool live;
  };
  [[nodiscard]] std::vector<PanelSection> left_sections(const ViewSettings& settings,
                                                        const PanelFacts& facts) const;
  [[nodiscard]] PanelSection joint_section(const PanelFacts& facts) const;
  void layout();

  mjuiState state_{};
  UiColumn left_{1};
  UiColumn right_{2};
  bool left_shown_ = false;
  bool right_shown_ = false;
  bool joints_open_ = true;
  bool can_step_;
  bool can_reset_;
  std::vector<Joint> joints_;
  std::vector<PanelSection> right_sections_;  ///< as shown last
};

}  // namespace mjarm::view
