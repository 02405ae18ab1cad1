#include "mpi/ranks.h"

#include <algorithm>
#include <stdexcept>

namespace radar::tools {

namespace {

constexpr uint64_t kPiece = 1u << 30;
constexpr int kTag = 1;

// Calls `use` with the start and the length of each piece of so many bytes.
template <class Use>
void forEachPiece(uint64_t size, const Use& use) {
  for (uint64_t start = 0; start < size; start += kPiece) use(start, static_cast<int>(std::min(kPiece, size - start)));
}

// Receives the pieces that follow a length.
std::string receivePieces(int rank, uint64_t size) {
  std::string bytes(size, '\0');
  forEachPiece(size, [&](uint64_t start, int length) {
    MPI_Recv(bytes.data() + start, length, MPI_BYTE, rank, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  });
  return bytes;
}

}  // namespace

MpiSession::MpiSession(int& argc, char**& argv) {
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
  MPI_Comm_rank(machine, &localRank_);
  MPI_Comm_size(machine, &localCount_);
  MPI_Comm_free(&machine);
}

MpiSession::~MpiSession() {
  MPI_Finalize();
}

std::string hostName() {
  char name[MPI_MAX_PROCESSOR_NAME] = {};
  int length = 0;
  MPI_Get_processor_name(name, &length);
  return {name, static_cast<size_t>(length)};
}

void broadcast(std::string& bytes) {
  uint64_t size = bytes.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  bytes.resize(size);
  forEachPiece(
      size, [&](uint64_t start, int length) { MPI_Bcast(bytes.data() + start, length, MPI_BYTE, 0, MPI_COMM_WORLD); });
}

bool broadcast(bool value) {
  int number = value ? 1 : 0;
  MPI_Bcast(&number, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return number == 1;
}

std::vector<std::string> gather(const std::string& bytes) {
  int rank = 0, count = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  if (rank > 0) {
    send(0, bytes);
    return {};
  }
  std::vector<std::string> all{bytes};
  for (int other = 1; other < count; ++other) all.push_back(receiveFrom(other));
  return all;
}

void send(int rank, const std::string& bytes) {
  const uint64_t size = bytes.size();
  MPI_Send(&size, 1, MPI_UINT64_T, rank, kTag, MPI_COMM_WORLD);
  forEachPiece(size, [&](uint64_t start, int length) {
    MPI_Send(bytes.data() + start, length, MPI_BYTE, rank, kTag, MPI_COMM_WORLD);
  });
}

std::string receiveFrom(int rank) {
  uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, rank, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return receivePieces(rank, size);
}

std::optional<Received> receiveIfAny() {
  int isThere = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &isThere, &status);
  if (isThere == 0) return std::nullopt;
  return Received{status.MPI_SOURCE, receiveFrom(status.MPI_SOURCE)};
}

void Outbox::send(int rank, std::string bytes) {
  Letter& letter = letters_.emplace_back();
  letter.bytes = std::move(bytes);
  letter.size = letter.bytes.size();
  MPI_Isend(&letter.size, 1, MPI_UINT64_T, rank, kTag, MPI_COMM_WORLD, &letter.requests.emplace_back());
  forEachPiece(letter.size, [&](uint64_t start, int length) {
    MPI_Isend(letter.bytes.data() + start, length, MPI_BYTE, rank, kTag, MPI_COMM_WORLD,
              &letter.requests.emplace_back());
  });
}

void Outbox::tidy() {
  std::erase_if(letters_, [](Letter& letter) {
    int done = 0;
    MPI_Testall(static_cast<int>(letter.requests.size()), letter.requests.data(), &done, MPI_STATUSES_IGNORE);
    return done != 0;
  });
}

void Outbox::wait() {
  for (Letter& letter : letters_) {
    MPI_Waitall(static_cast<int>(letter.requests.size()), letter.requests.data(), MPI_STATUSES_IGNORE);
  }
  letters_.clear();
}

}  // namespace radar::tools
