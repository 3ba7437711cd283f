// Where answers go, for every command that writes a file: what stood there before, folders that are
// missing or in the way, equal runs, and Ctrl-C.
#include <gmock/gmock.h>

#include <filesystem>

#include "apps/mjarm/commands/crane_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A command that writes one file, without its `--out`, and the ending of that file.
struct Writer {
  std::vector<std::string> words;
  std::string ending;
};

class Outputs : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<Writer> writers() const {
    return {{{"fk", "--robot", robot_, "--q", "0,0,0"}, ".jsonl"},
            {{"ik", "--robot", robot_, "--pos", "0.3,0.2,0.3", "--task", "position", "--no-timing"},
             ".jsonl"},
            {{"path", "--robot", "ur5e", "--from", "0.3,-0.4,0.4", "--to", "0.2,-0.4,0.4", "--quat",
              "0,1,0,0", "--no-timing"},
             ".jsonl"},
            {{"time", "--problem", "p2p", "--robot", robot_, "--points", "0,0,0;1,1,10cm",
              "--no-timing", "--dt", "0.1"},
             ".json"},
            {{"plan", "--robot", robot_, "--goal", "1,-1,0.1", "--no-timing"}, ".json"},
            {{"model", "export", robot_}, ".urdf"},
            {{"workspace", "--robot", robot_, "--step", "150mm", "--slice", "z=0.3"}, ".csv"},
            {{"export", "point", "--to", "urscript"}, ".script"}};
  }
  support::ProgramResult write(const Writer& writer, const std::string& out) {
    std::vector<std::string> words = writer.words;
    words.insert(words.end(), {"--out", out});
    return mjarm(words, {.folder = folder_.path(), .input = {}, .environment = {}});
  }
  /// Names of what lies in the folder of the test.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      out.push_back(entry.path().lexically_relative(folder_.path()).string());
    }
    std::ranges::sort(out);
    return out;
  }

  support::TempFolder folder_;
  std::string robot_ = folder_.write("crane.xml", kCrane).string();
};

TEST_F(Outputs, ASecondRunWritesTheSameBytesInPlaceOfTheFirst) {
  for (const Writer& writer : writers()) {
    SCOPED_TRACE(writer.words.front());
    const std::string name = "out" + writer.ending;
    folder_.write(name, std::string(100000, 'x'));  // longer than what comes
    std::string first;
    for (int i = 0; i < 2; ++i) {
      const auto result = write(writer, name);
      ASSERT_EQ(result.exit_code, 0) << result.err;
      if (i == 0) first = folder_.read(name);
    }
    EXPECT_FALSE(first.empty());
    EXPECT_EQ(first.find("xxxx"), std::string::npos);
    EXPECT_EQ(folder_.read(name), first);
    fs::remove(folder_.path() / name);
    EXPECT_EQ(names(), std::vector<std::string>{"crane.xml"});
  }
}

TEST_F(Outputs, FoldersThatAreMissingOrInTheWayAreOneLineAndLeaveNothing) {
  fs::create_directory(folder_.path() / "taken");
  for (const Writer& writer : writers()) {
    SCOPED_TRACE(writer.words.front());
    const auto missing = write(writer, "no/such/out" + writer.ending);
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_THAT(missing.err, HasSubstr("no/such/out" + writer.ending + ": cannot be written"));
    const std::string taken = "taken/out" + writer.ending;
    fs::create_directory(folder_.path() / taken);
    const auto folder = write(writer, taken);
    EXPECT_NE(folder.exit_code, 0);
    EXPECT_THAT(folder.err, HasSubstr(taken));
    EXPECT_EQ(support::lines_of(folder.err).size(), 1U) << folder.err;
    EXPECT_EQ(folder.out, "");
    EXPECT_TRUE(fs::is_empty(folder_.path() / taken));
    fs::remove(folder_.path() / taken);
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"crane.xml", "taken"}));
}

TEST_F(Outputs, BadInputLeavesTheOldAnswersAlone) {
  folder_.write("bad.jsonl", "{\"q\":[0,0,0],\"pos\":[0,0,0],\"quat\":[1,0,0,0]}\nbad\n");
  folder_.write("old", "old answers");
  const std::vector<std::string> before = names();
  const std::vector<std::vector<std::string>> commands = {
      {"fk", "--robot", robot_, "--in", "bad.jsonl"},
      {"ik", "--robot", robot_, "--in", "bad.jsonl", "--threads", "3"},
      {"path", "--robot", robot_, "--in", "bad.jsonl"},
      {"time", "--problem", "path_va", "--in", "bad.jsonl"},
      {"plan", "--in", "bad.jsonl"},
      {"plan", "--robot", robot_, "--goal", "0,0,90deg"},
      {"model", "export", "bad.jsonl", "--to", "urdf"},
      {"export", "bad.jsonl", "--to", "urscript"}};
  for (std::vector<std::string> words : commands) {
    SCOPED_TRACE(::testing::PrintToString(words));
    words.insert(words.end(), {"--out", "old"});
    const auto result = mjarm(words, {.folder = folder_.path(), .input = {}, .environment = {}});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_FALSE(only_line(result).empty());
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(folder_.read("old"), "old answers");
    EXPECT_EQ(names(), before);
  }
}

TEST_F(Outputs, NoAnswerIsAnAnswerToo) {
  // What cannot be done is exit code 1, and the file says so.
  const std::pair<Writer, const char*> cases[] = {
      {{{"ik", "--robot", robot_, "--pos", "3,0,0", "--task", "position"}, ""}, "\"ok\":false"},
      {{{"path", "--robot", "ur5e", "--from", "0.3,-0.4,0.4", "--to", "3,-0.4,0.4", "--quat",
         "0,1,0,0"},
        ""},
       "\"ok\":false"},
      {{{"plan", "--robot", robot_, "--goal", "0,0,9m"}, ""}, "\"ok\":false"}};
  for (const auto& [writer, says] : cases) {
    const auto result = write(writer, "answer.json");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_FALSE(only_line(result).empty());
    EXPECT_THAT(folder_.read("answer.json"), HasSubstr(says));
    fs::remove(folder_.path() / "answer.json");
  }
}

/// Runs a shell script in the folder of the test, with `$mjarm` and `$robot`. `end` sends a signal
/// to the last program in the background and leaves its exit code.
support::ProgramResult disturb(const support::TempFolder& folder, const std::string& robot,
                               const std::string& script) {
  const std::string begin = "mjarm='" MJARM_PROGRAM "'; robot='" + robot +
                            "'; end() { pid=$!; kill -$1 $pid; wait $pid; };";
  return support::run_program("/bin/sh", {"-c", begin + script},
                              {.folder = folder.path(), .input = {}, .environment = {}});
}

TEST_F(Outputs, AStreamThatIsStoppedHasGivenEveryAnswerSoFar) {
  for (const char* const signal : {"INT", "TERM"}) {
    const auto result =
        disturb(folder_, robot_,
                "rm -f pipe out; mkfifo pipe; exec 3<>pipe; echo '{\"q\":[0,0,0]}' >&3;"
                "\"$mjarm\" fk --robot \"$robot\" --in - <pipe >out &"
                "while [ ! -s out ]; do sleep 0.02; done; end " +
                    std::string(signal));
    EXPECT_EQ(result.exit_code, 1) << signal;
    EXPECT_THAT(only_line(result), HasSubstr("stopped by the user"));
    EXPECT_EQ(json_lines(folder_.read("out")).size(), 1U);
  }
}

TEST_F(Outputs, AFileThatIsStoppedIsNeverThere) {
  // The temporary file tells that it has begun.
  std::string lines;
  for (int i = 0; i < 100000; ++i) lines += "{\"pos\":[0.3,0.2,0.3],\"quat\":[0,1,0,0]}\n";
  folder_.write("poses.jsonl", lines);
  for (const char* const signal : {"INT", "TERM"}) {
    const auto result = disturb(folder_, robot_,
                                "mkdir -p out; \"$mjarm\" ik --robot ur5e --in poses.jsonl "
                                "--out out/sol.jsonl --threads 2 &"
                                "while [ -z \"$(ls out)\" ]; do sleep 0.02; done; end " +
                                    std::string(signal));
    EXPECT_EQ(result.exit_code, 1) << signal;
    EXPECT_THAT(only_line(result), HasSubstr("stopped by the user"));
    EXPECT_TRUE(fs::is_empty(folder_.path() / "out"));
  }
}

TEST_F(Outputs, AReaderThatHangsUpEndsTheProgram) {
  // As in `mjarm fk --in q.jsonl | head -1`: no endless work for nobody.
  std::string lines;
  for (int i = 0; i < 20000; ++i) lines += "{\"q\":[0,0,0]}\n";
  folder_.write("q.jsonl", lines);
  const auto result = disturb(folder_, robot_,
                              "{ \"$mjarm\" fk --robot \"$robot\" --in q.jsonl; echo $? >code; } | "
                              "head -1");
  EXPECT_EQ(support::lines_of(result.out).size(), 1U);
  EXPECT_NE(folder_.read("code"), "0\n");
}

}  // namespace
}  // namespace mjarm::app
