#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "mjarm/core/file.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/output_folder.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A process that holds a folder until it is killed.
class Holder {
 public:
  explicit Holder(const fs::path& folder) {
    if (pipe(ready_) != 0) return;
    child_ = fork();
    if (child_ == 0) {
      const auto held = OutputFolder::open(folder);
      auto unfinished = AtomicFile::create(folder / "log.csv");
      const char said = held && unfinished ? 'y' : 'n';
      if (write(ready_[1], &said, 1) != 1) _exit(1);
      for (;;) pause();
    }
    char said = 0;
    holds_ = read(ready_[0], &said, 1) == 1 && said == 'y';
  }
  ~Holder() {
    kill_it();
    close(ready_[0]);
    close(ready_[1]);
  }
  void kill_it() {
    if (child_ <= 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
    child_ = -1;
  }
  bool holds() const { return holds_; }
  pid_t process() const { return child_; }

 private:
  int ready_[2] = {-1, -1};
  pid_t child_ = -1;
  bool holds_ = false;
};

int files_in(const fs::path& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(OutputFolder, IsMadeAndNamesTheProcessThatHoldsIt) {
  const LanguageScope english(Language::english);
  const support::TempFolder temp;
  const fs::path folder = temp.path() / "a" / "b";
  Holder holder(folder);
  ASSERT_TRUE(holder.holds());
  const auto second = OutputFolder::open(folder);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, Errc::impossible);
  EXPECT_THAT(second.error().what, HasSubstr(folder.string()));
  EXPECT_THAT(second.error().what, HasSubstr("process " + std::to_string(holder.process())));
}

TEST(OutputFolder, ClearsWhatAKilledProcessLeftAndNothingElse) {
  const support::TempFolder temp;
  Holder holder(temp.path());
  ASSERT_TRUE(holder.holds());
  ASSERT_EQ(files_in(temp.path()), 1) << "the unfinished log";
  holder.kill_it();
  for (const char* other : {"notes.tmp", "a.tmp12", "b.tmp-1", ".tmp99999999-0", "c.tmp1x-2"}) {
    ASSERT_TRUE(write_file(temp.path() / other, "mine"));
  }
  auto running = AtomicFile::create(temp.path() / "growing.csv");
  ASSERT_TRUE(running);
  ASSERT_TRUE(OutputFolder::open(temp.path()));
  EXPECT_EQ(files_in(temp.path()), 6) << "five of others, and what this process writes";
  EXPECT_TRUE(running->commit());
}

TEST(OutputFolder, AFileIsNoFolder) {
  const support::TempFolder temp;
  const auto file = temp.write("file", "");
  EXPECT_FALSE(OutputFolder::open(file));
}

}  // namespace
}  // namespace mjarm
