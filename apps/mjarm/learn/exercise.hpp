#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/cli/robot.hpp"
#include "mjarm/core/result.hpp"

/// The exercises of the learning path (docs/learn): what a reader made is looked at, and told what
/// is right and what is missing. All of it is computed; only what an exercise asks for is written
/// down here.
namespace mjarm::app {

/// What a reader hands in.
struct Exercise {
  std::string file;         ///< as given, else the page's own name; empty where there is none
  bool given = false;       ///< the reader named it
  RobotChoice robot = {};   ///< the page's own where empty
  std::string python = "";  ///< program that runs files of Python; empty: that of PATH
};

/// The robot that the reader named, else that of the page.
[[nodiscard]] inline Result<Robot> robot_of(const Exercise& exercise, const char* page) {
  RobotChoice choice = exercise.robot;
  if (choice.robot.empty()) choice.robot = page;
  return load_robot(choice);
}

/// One line about an exercise.
struct LearnLine {
  enum class Kind { right, wrong, note };
  Kind kind = Kind::note;
  std::string what;
};

/// What was found, in the order in which a reader should think of it.
class LearnReport {
 public:
  void right(std::string what) { lines_.push_back({LearnLine::Kind::right, std::move(what)}); }
  void wrong(std::string what) { lines_.push_back({LearnLine::Kind::wrong, std::move(what)}); }
  void note(std::string what) { lines_.push_back({LearnLine::Kind::note, std::move(what)}); }

  [[nodiscard]] const std::vector<LearnLine>& lines() const { return lines_; }
  /// How many are wrong; 0 where all is right.
  [[nodiscard]] std::size_t wrong_count() const {
    std::size_t count = 0;
    for (const LearnLine& line : lines_) count += line.kind == LearnLine::Kind::wrong;
    return count;
  }

 private:
  std::vector<LearnLine> lines_;
};

/// Looks at an exercise. @return an error where it cannot be read; it names the file, and the line
/// where there is one.
using LearnCheck = Result<LearnReport>(const Exercise& exercise);

LearnCheck check_ellipse;        ///< page 1: a folder with report.json
LearnCheck check_box;            ///< page 2: an MJCF file
LearnCheck check_moving_pose;    ///< page 3: joint values and a place
LearnCheck check_turn;           ///< page 4: quaternions, one a line
LearnCheck check_ik_answers;     ///< page 5: poses and joint values, one a line
LearnCheck check_own_path;       ///< page 6: a motion program
LearnCheck check_two_objects;    ///< page 7: a motion program
LearnCheck check_static_error;   ///< page 8: no file, or a solver in Python
LearnCheck check_policy_or_rrt;  ///< page 9: a folder of a training, or a planner in Python

}  // namespace mjarm::app
