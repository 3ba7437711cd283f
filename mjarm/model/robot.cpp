#include "mjarm/model/robot.hpp"

#include <utility>

namespace mjarm {

Result<Robot> load_robot(const std::string& name_or_path, const RobotOptions& options) {
  const Result<std::filesystem::path> file = find_model_file(name_or_path);
  if (!file) return fail(file.error());
  Result<Model> model = Model::load(*file, options.load);
  if (!model) return fail(std::move(model.error()));
  Result<Arm> arm = find_arm(*model, {.tip = options.tip});
  if (!arm) return fail(std::move(arm.error()));
  return Robot{std::move(*model), std::move(*arm)};
}

}  // namespace mjarm
