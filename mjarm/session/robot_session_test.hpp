#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/session/robot_session.hpp"

namespace mjarm::session {

/// A robot in a session, without a window.
class RobotInView : public ::testing::Test {
 protected:
  void step(int steps) {
    for (int i = 0; i < steps; ++i) view_.step();
  }
  const view::ViewFrame& frame() {
    view_.fill(frame_);
    return frame_;
  }
  /// The item with this name; its section and place in the panel as well.
  struct Place {
    const view::PanelItem* item = nullptr;
    int section = -1;
    int index = -1;
  };
  Place place(const std::string& title, const std::string& name) {
    const std::vector<view::PanelSection>& panels = frame().panels;
    for (std::size_t i = 0; i < panels.size(); ++i) {
      if (panels[i].title != title) continue;
      for (std::size_t k = 0; k < panels[i].items.size(); ++k) {
        const view::PanelItem& item = panels[i].items[k];
        if (item.name == name) return {&item, static_cast<int>(i), static_cast<int>(k)};
      }
    }
    ADD_FAILURE() << title << ": " << name;
    std::abort();
  }
  void use(const std::string& title, const std::string& name, double value = 1) {
    view_.handle(view::PanelEvent{place(title, name).item->id, value});
  }
  std::string shown(const std::string& title, const std::string& name) {
    return std::get<view::PanelText>(place(title, name).item->what).value;
  }
  [[nodiscard]] const ToolTarget& target() { return view_.target()->target(); }
  [[nodiscard]] Pose tool() const { return sim_.sim().tool(arm_); }
  void expect_there(const Pose& X_WT) const {
    EXPECT_LT((tool().p - X_WT.p).norm(), 2e-3);
    EXPECT_LT(angle_between(tool().R, X_WT.R), 5e-3);
  }
  void drag(const Pose& X_WT, bool held) {
    view_.target()->link().drags.push({{X_WT, held, ++drags_}});
    EXPECT_TRUE(view_.take_drags());
    EXPECT_FALSE(view_.take_drags());
  }

  Model model_ = Model::load(find_model_file("ur5e").value()).value();
  Arm arm_ = find_arm(model_).value();
  FreeSim sim_ = FreeSim::create(model_, arm_, false).value();
  RobotSession view_{model_, arm_, sim_};
  view::ViewFrame frame_;
  long drags_ = 0;
};

}  // namespace mjarm::session
