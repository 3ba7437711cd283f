#include <array>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <new>
#include <shared_mutex>

#include "mjarm/core/messages/guard.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/compile_apart_internal.hpp"
#include "mjarm/model/compile_cache_internal.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/model_trial.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {
namespace {

/// A process must not be copied while another thread of it is inside MuJoCo's compiler: the copy
/// would find its locks taken, and nobody there to give them back.
std::shared_mutex& compiler_lock() {
  static std::shared_mutex lock;
  return lock;
}

void put(std::string& out, std::size_t number) {
  const auto fixed = static_cast<std::uint64_t>(number);
  out.append(reinterpret_cast<const char*>(&fixed), sizeof fixed);
}

void put(std::string& out, const std::vector<std::string>& lines) {
  put(out, lines.size());
  for (const std::string& line : lines) {
    put(out, line.size());
    out += line;
  }
}

/// Reads what `put` has written; false where there is too little.
bool take(std::string_view& in, std::size_t& number) {
  std::uint64_t fixed = 0;
  if (in.size() < sizeof fixed) return false;
  std::memcpy(&fixed, in.data(), sizeof fixed);
  in.remove_prefix(sizeof fixed);
  number = static_cast<std::size_t>(fixed);
  return true;
}

bool take(std::string_view& in, std::vector<std::string>& lines) {
  std::size_t count = 0;
  if (!take(in, count)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t length = 0;
    if (!take(in, length) || length > in.size()) return false;
    lines.emplace_back(in.substr(0, length));
    in.remove_prefix(length);
  }
  return true;
}

void tell_error(const ChildVoice& voice, const Error& error) {
  voice.send(std::string{kTrialError, static_cast<char>(error.code)} + error.what);
}

void tell_model(const ChildVoice& voice, const LoadedModel& loaded) {
  std::string out(1, kTrialModel);
  put(out, loaded.warnings);
  put(out, loaded.read_files);
  voice.send(out);
  const mjtSize size = mj_sizeModel(loaded.model.get());
  const std::unique_ptr<char[]> bytes(new char[static_cast<std::size_t>(size)]);
  mj_saveModel(loaded.model.get(), nullptr, bytes.get(), size);
  voice.send({bytes.get(), static_cast<std::size_t>(size)});
}

/// The part of the work that is done in the copy.
void work(const SpecSource& source, const ChildVoice& voice) {
  const auto tell_stage = [&](Stage stage) {
    const char letter = static_cast<char>(stage);
    voice.send({&letter, 1});
  };
  mj_setCacheCapacity(mj_getCache(), 0);  // the copy reads every mesh once
  try {
    const Result<LoadedModel> loaded = compile_here(source, tell_stage);
    if (!loaded) {
      tell_error(voice, loaded.error());
    } else if (static_cast<std::size_t>(mj_sizeModel(loaded->model.get())) >
               kTrialLimits.answer / 2) {
      tell_error(voice, {Errc::bad_input,
                         text(msg::guard_too_large, source.name(), kTrialLimits.answer / 2)});
    } else {
      tell_model(voice, *loaded);
    }
  } catch (const std::bad_alloc&) {
    tell_error(voice, {Errc::bad_input,
                       text(msg::model_refused, source.name(), text(msg::model_mj_memory))});
  }
}

/// The model that `tell_model` has sent; none where the answer is broken.
std::optional<LoadedModel> read_model(std::string_view said) {
  LoadedModel loaded;
  if (!take(said, loaded.warnings) || !take(said, loaded.read_files)) return std::nullopt;
  mjModel* model = nullptr;
  const MujocoOutcome outcome = call_mujoco(
      [&] { model = mj_loadModelBuffer(said.data(), static_cast<mjtSize>(said.size())); });
  if (outcome.failed || model == nullptr) return std::nullopt;
  loaded.model.reset(model);
  return loaded;
}

Result<ChildResult> compile_in_child(const SpecSource& source) {
  std::unique_lock forking(compiler_lock());
  return run_in_child([&](const ChildVoice& voice) { work(source, voice); }, kTrialLimits,
                      [&] { forking.unlock(); });
}

Result<LoadedModel> compile_apart(const SpecSource& source) {
  const std::optional<CompileCache> cache = CompileCache::of(source);
  if (cache) {
    const std::shared_lock in_use(compiler_lock());
    if (std::optional<LoadedModel> known = cache->find(read_model)) return std::move(*known);
  }
  Result<ChildResult> result = compile_in_child(source);
  // Threads that are not ours may have held a lock when the copy was made; seldom twice.
  if (result && result->end == ChildEnd::stuck) result = compile_in_child(source);
  if (!result) return fail(result.error());
  std::string_view said = result->said;
  const Stage stage = take_stages(said);
  if (result->end != ChildEnd::done || said.size() < 2)
    return fail(bad_end(source, *result, stage));
  const char kind = said.front();
  said.remove_prefix(1);
  if (kind == kTrialError) {
    return fail(static_cast<Errc>(said.front()), std::string(said.substr(1)));
  }
  const std::shared_lock in_use(compiler_lock());
  std::optional<LoadedModel> loaded = read_model(said);
  if (!loaded) return fail(bad_end(source, {}, stage));
  if (cache) cache->keep(said, *loaded);
  return std::move(*loaded);
}

}  // namespace

Result<LoadedModel> compile_spec(const SpecSource& source) {
  if (!source.trusted) return compile_apart(source);
  const std::shared_lock in_use(compiler_lock());
  return compile_here(source, nullptr);
}

std::optional<int> model_trial(const std::vector<std::string>&) { return std::nullopt; }

}  // namespace mjarm
