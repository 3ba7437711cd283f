#include "mjarm/core/program_name.hpp"

#include <gtest/gtest.h>

#include "mjarm/core/messages.hpp"

namespace mjarm {
namespace {

class ProgramNames : public ::testing::Test {
 protected:
  void SetUp() override { set_program_name("./dev", {"run", "models"}); }
  void TearDown() override { set_program_name("mjarm", {}); }
};

TEST(ProgramName, IsOursWhereNobodySetsOne) {
  EXPECT_EQ(program_name(), "mjarm");
  EXPECT_EQ(with_program_name("get it with: mjarm models install"),
            "get it with: mjarm models install");
}

TEST_F(ProgramNames, StandsBeforeCommandsAlone) {
  EXPECT_EQ(program_name(), "./dev");
  EXPECT_EQ(with_program_name("  mjarm run a\n  mjarm models install（mjarm run）`mjarm run`"),
            "  ./dev run a\n  ./dev models install（./dev run）`./dev run`");
  for (const char* other : {"build mjarm again", "a mjarm", "share/mjarm run", "as mjarm runs",
                            "xmjarm run", " mjarm", "mjarm", ""}) {
    EXPECT_EQ(with_program_name(other), other);
  }
  EXPECT_EQ(with_program_name("mjarm run: a title"), "mjarm run: a title");
  set_program_name("./dev", {"命令", "--help"});
  EXPECT_EQ(with_program_name("见 mjarm --help、mjarm 命令"), "见 ./dev --help、./dev 命令");
}

TEST_F(ProgramNames, MessagesHaveItAndTheirValuesStay) {
  constexpr Msg kHint = {"{}: mend it with: mjarm models install {}",
                         "{}：mjarm models install {}"};
  EXPECT_EQ(text(kHint, "of mjarm run", "a"), "of mjarm run: mend it with: ./dev models install a");
  set_program_name("odd {} name", {"models"});
  EXPECT_EQ(text(kHint, "b", "a"), "b: mend it with: odd {} name models install a");
}

}  // namespace
}  // namespace mjarm
