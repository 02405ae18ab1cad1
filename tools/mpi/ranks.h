// Bytes between the ranks of a run, of any length: MPI counts them in an int. An error of MPI ends the run.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <list>
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
};

/// The host's name.
std::string hostName();

/// Rank 0's bytes reach all ranks.
void broadcast(std::string& bytes);
/// Rank 0's value reaches all ranks.
bool broadcast(bool value);
/// All ranks' bytes, on rank 0; elsewhere nothing.
std::vector<std::string> gather(const std::string& bytes);

void send(int rank, const std::string& bytes);
std::string receiveFrom(int rank);
/// What another rank sent, if there is something.
struct Received {
  int rank = 0;
  std::string bytes;
};
std::optional<Received> receiveIfAny();

/// Sends that are under way.
class Outbox {
 public:
  void send(int rank, std::string bytes);
  /// Forgets those that arrived.
  void tidy();
  /// Waits until all arrived.
  void wait();

 private:
  struct Letter {
    uint64_t size = 0;
    std::string bytes;
    std::vector<MPI_Request> requests;
  };
  std::list<Letter> letters_;
};

}  // namespace radar::tools
