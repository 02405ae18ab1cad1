#include "batch/atomic_file.h"

#include "support/catch.h"
#include "support/scratch_folder.h"

using namespace radar;
using namespace radar::tools;

TEST_CASE("writeAtomically writes a whole file or leaves nothing") {
  const radar::test::ScratchFolder folder;
  writeAtomically(folder.path() / "a", "first");
  writeAtomically(folder.path() / "a", "second");
  CHECK(folder.read("a") == "second");
  CHECK_THROWS_WITH(writeAtomically(folder.path() / "no" / "a", "x"), test::Contains("no/a"));
  std::filesystem::create_directory(folder.path() / "b");
  CHECK_THROWS(writeAtomically(folder.path() / "b", "x"));
  CHECK(folder.list() == "a b");
}
