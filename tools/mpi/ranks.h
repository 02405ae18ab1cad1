// What the ranks of a run send each other. An error of MPI ends the run.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace radar::tools {

/// MPI from here to the end of the program; one thread calls it.
class MpiSession {
 public:
  MpiSession(int& argc, char**& argv);
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  int rank() const { return rank_; }
  int count() const { return count_; }
  /// This rank among those of its machine, and how many these are.
  int localRank() const { return localRank_; }
  int localCount() const { return localCount_; }

 private:
  int rank_ = 0, count_ = 1, localRank_ = 0, localCount_ = 1;
  std::vector<std::byte> outgoing_;  ///< room for chunks that are under way
};

/// The host's name.
std::string hostName();

/// Rank 0's value reaches all ranks.
bool broadcast(bool value);
/// All ranks' texts, on rank 0; elsewhere nothing.
std::vector<std::string> gather(const std::string& text);

/// Consecutive queries of the file; none: the work is done.
struct Chunk {
  uint64_t first = 0, count = 0;
};
/// What answering a chunk took and came to.
struct ChunkReport {
  Chunk chunk;
  double seconds = 0;
  bool someInvalid = false, failed = false;
};
/// The answers to a chunk.
struct Answered : ChunkReport {
  std::string text;  ///< rows of the answer file; if it failed, what ended the rank
};

/// From rank 0, which does not wait for the other. At most three chunks are under way to a rank.
void send(int rank, Chunk chunk);
Chunk receiveChunk();
/// To rank 0.
void send(const Answered& answered);
/// What another rank sent, if there is something.
struct Received {
  int rank = 0;
  Answered answered;
};
std::optional<Received> receiveIfAny();

}  // namespace radar::tools
