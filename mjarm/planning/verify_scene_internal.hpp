#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "mjarm/collision/first_contact.hpp"
#include "mjarm/collision/sphere_model.hpp"
#include "mjarm/collision/verify_edge.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/planning/problem_file.hpp"
#include "mjarm/planning/verify_path.hpp"

namespace mjarm::detail {

/// What a path is judged against, without anything that planned it.
class VerifyScene {
 public:
  using Row = std::span<const double>;
  virtual ~VerifyScene() = default;
  [[nodiscard]] virtual const Arm& arm() const = 0;
  [[nodiscard]] virtual Result<VerifyResult> edge(Row q0, Row q1, const VerifyOptions& options) = 0;
  /// The names of what VerifyResult tells.
  [[nodiscard]] virtual std::pair<std::string, std::string> names(
      const VerifyResult& found) const = 0;
  /// [m] between a link and something else at `q`; none where no such pair can meet.
  [[nodiscard]] virtual Result<std::optional<double>> distance(const std::string& link,
                                                               const std::string& other, Row q) = 0;
  /// The first sample of an edge where MuJoCo sees a contact; its geoms are called as above, but
  /// those of a model by their own names.
  [[nodiscard]] virtual Result<std::optional<EdgeContact>> contact(Row q0, Row q1,
                                                                   const VerifyRules& rules) = 0;
};

/// A robot of spheres among obstacles.
class SphereVerifyScene final : public VerifyScene {
 public:
  SphereVerifyScene(const ProblemFile& file, const PlanProblem& problem)
      : file_(file), problem_(problem) {}

  const Arm& arm() const override { return file_.arm; }
  Result<VerifyResult> edge(Row q0, Row q1, const VerifyOptions& options) override {
    return verify_edge(file_.arm, file_.spheres, problem_.obstacles, q0, q1, options);
  }
  std::pair<std::string, std::string> names(const VerifyResult& found) const override;
  Result<std::optional<double>> distance(const std::string& link, const std::string& other,
                                         Row q) override;
  Result<std::optional<EdgeContact>> contact(Row q0, Row q1, const VerifyRules& rules) override;

 private:
  [[nodiscard]] const std::string& name_of(int link) const {
    return file_.spheres.links[static_cast<std::size_t>(link)].name;
  }

  const ProblemFile& file_;
  const PlanProblem& problem_;
  std::optional<SphereModel> model_;  // made when it is needed first
  std::optional<ExactChecker> exact_;
};

/// A robot as its model has it.
class ModelVerifyScene final : public VerifyScene {
 public:
  ModelVerifyScene(ModelMarch march, ExactChecker exact, const Arm& arm)
      : march_(std::move(march)), exact_(std::move(exact)), arm_(arm) {}

  const Arm& arm() const override { return arm_; }
  Result<VerifyResult> edge(Row q0, Row q1, const VerifyOptions& options) override {
    return march_.verify_edge(q0, q1, options);
  }
  std::pair<std::string, std::string> names(const VerifyResult& found) const override {
    return {march_.link_name(found.link), found.obstacle >= 0 ? march_.obstacle_name(found.obstacle)
                                                              : march_.link_name(found.other_link)};
  }
  Result<std::optional<double>> distance(const std::string& link, const std::string& other,
                                         Row q) override {
    return march_.distance(link, other, q);
  }
  Result<std::optional<EdgeContact>> contact(Row q0, Row q1, const VerifyRules& rules) override {
    return first_contact(exact_, q0, q1, rules.step, rules.stop);
  }

 private:
  ModelMarch march_;
  ExactChecker exact_;
  const Arm& arm_;
};

}  // namespace mjarm::detail
