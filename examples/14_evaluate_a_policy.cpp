// A trained policy, tried on goals that training has never seen, and written for other programs.
#include <cstdio>
#include <filesystem>

#include "mjarm/rl/evaluate.hpp"
#include "mjarm/rl/onnx_export.hpp"
#include "mjarm/rl/reach_env.hpp"
#include "mjarm/rl/trained_policy.hpp"

int main() {
  // A checkpoint knows the task it was trained for, and the task its scene.
  const auto trained =
      mjarm::find_model_file("policies/reach.safetensors").and_then([](const auto& file) {
        return mjarm::rl::load_policy(file);
      });
  if (!trained) return std::fprintf(stderr, "%s\n", trained.error().what.c_str()), 1;
  const auto model = mjarm::rl::reach_model(trained->task);
  if (!model) return std::fprintf(stderr, "%s\n", model.error().what.c_str()), 1;

  // 100 episodes at the same time, each with a goal of its own.
  const auto evaluation =
      mjarm::rl::evaluate(*model, trained->task, trained->policy, {.episodes = 100, .seed = 7});
  if (!evaluation) return std::fprintf(stderr, "%s\n", evaluation.error().what.c_str()), 1;
  std::printf("within 2 cm of %.0f %% of %d goals, median %.1f mm, after %.0f actions\n",
              100 * evaluation->within_2cm, evaluation->episodes, 1e3 * evaluation->median,
              evaluation->steps_to_2cm);

  // The mean action as an ONNX model: input "observation", output "action".
  const auto file = std::filesystem::temp_directory_path() / "mjarm_example_reach.onnx";
  const auto written = mjarm::rl::save_onnx(file, trained->policy.tensors());
  if (!written) return std::fprintf(stderr, "%s\n", written.error().what.c_str()), 1;
  std::printf("%s: %ju bytes\n", file.c_str(), std::filesystem::file_size(file));
  std::filesystem::remove(file);
  return evaluation->within_2cm > 0.9 ? 0 : 1;
}
