#include "apps/mjarm/learn/learn_pages.hpp"

#include "apps/mjarm/messages/learn.hpp"

namespace mjarm::app {

std::span<const LearnPage> learn_pages() {
  static const LearnPage pages[] = {
      {"01_set_up", msg::learn_title_1, msg::learn_about_1, "mine", msg::learn_how_1,
       check_ellipse},
      {"02_mjcf", msg::learn_title_2, msg::learn_about_2, "falls.xml", msg::learn_how_2, check_box},
      {"03_model_and_data", msg::learn_title_3, msg::learn_about_3, "moving.json", msg::learn_how_3,
       check_moving_pose},
      {"04_pose", msg::learn_title_4, msg::learn_about_4, "turn.jsonl", msg::learn_how_4,
       check_turn},
      {"05_inverse_kinematics", msg::learn_title_5, msg::learn_about_5, "answers.jsonl",
       msg::learn_how_5, check_ik_answers},
      {"06_moves_and_paths", msg::learn_title_6, msg::learn_about_6, "own.yaml", msg::learn_how_6,
       check_own_path},
      {"07_four_layers", msg::learn_title_7, msg::learn_about_7, "can.yaml", msg::learn_how_7,
       check_two_objects},
      {"08_three_pits", msg::learn_title_8, msg::learn_about_8, "", msg::learn_how_8,
       check_static_error},
      {"09_learning", msg::learn_title_9, msg::learn_about_9, "", msg::learn_how_9,
       check_policy_or_rrt},
  };
  return pages;
}

}  // namespace mjarm::app
