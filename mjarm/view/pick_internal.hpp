#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mjarm/render/scene.hpp"
#include "mjarm/view/events.hpp"

namespace mjarm::view {

/// A point of the picture: shares of its width and height, from the lower left, and its shape.
struct PicturePoint {
  double x = 0;
  double y = 0;
  double aspect = 1;  ///< width over height
};

/// What is selected in a scene, and the push on it; kept in the scene's mjvPerturb, which draws
/// both.
class Picker {
 public:
  explicit Picker(render::Scene& scene) : scene_(scene) {}

  /// Selects what is drawn at `point`; nothing is selected where there is nothing.
  SelectEvent select(const PicturePoint& point);
  /// Takes hold of what is at `point`: to push it (`twist` = false) or to turn it.
  /// @return false where there is nothing that could move.
  bool take_hold(const PicturePoint& point, bool twist);
  /// @param dx, dy way of the cursor as a share of the view's height, y up.
  void drag(double dx, double dy);
  [[nodiscard]] bool holds() const;
  /// The push at the state of the scene; none while nothing is held.
  [[nodiscard]] std::optional<PushEvent> push();
  std::optional<ReleaseEvent> let_go();

  /// Number of the selected body; -1 = none.
  [[nodiscard]] int body() const;
  /// What is told of the selected body: names and values, line by line.
  struct Row {
    std::string name;
    std::string value;
  };
  [[nodiscard]] std::vector<Row> describe() const;

 private:
  [[nodiscard]] bool can_move(int body) const;

  render::Scene& scene_;
  int geom_ = -1;
  bool twist_ = false;
};

}  // namespace mjarm::view
