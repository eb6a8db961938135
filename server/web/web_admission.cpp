#include "server/web/web_admission.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace alvor {

bool WebAdmission::admit(const std::shared_ptr<WebConnection>& connection, const std::string& address) {
  const Lock lock(mutex_);
  if (is_stopping_) return false;
  const auto count = by_address_.find(address);
  const bool is_crowded = !address.empty() && count != by_address_.end() && count->second >= limits_.connections_of_one_address;
  if (is_crowded && !evict_from(address)) return false;
  if (guests_.size() >= limits_.connections && !evict_any()) return false;
  const auto guest = guests_.insert(guests_.end(), {connection, connection.get(), address});
  by_connection_.emplace(connection.get(), guest);
  ++by_address_[address];
  return true;
}

void WebAdmission::leave(const WebConnection* connection) {
  const Lock lock(mutex_);
  if (const auto found = by_connection_.find(connection); found != by_connection_.end()) erase(found->second);
  has_left_.notify_all();
}

void WebAdmission::make_room() {
  const Lock lock(mutex_);
  evict_any();
}

void WebAdmission::stop() {
  const Lock lock(mutex_);
  is_stopping_ = true;
  for (const Guest& guest : guests_)
    if (const auto connection = guest.connection.lock()) connection->stop();
}

void WebAdmission::wait_until_empty(WebLimits::Time patience) {
  Lock lock(mutex_);
  has_left_.wait_for(lock, patience, [this]() ALVOR_REQUIRES(mutex_) { return guests_.empty(); });
}

void WebAdmission::close_all() {
  const Lock lock(mutex_);
  for (const Guest& guest : guests_)
    if (const auto connection = guest.connection.lock()) connection->close();
}

/// Closes the oldest waiting connection of this address. Returns whether there was one.
bool WebAdmission::evict_from(const std::string& address) {
  const auto oldest = std::ranges::find_if(guests_, [&](const Guest& guest) {
    if (guest.address != address) return false;
    const auto connection = guest.connection.lock();
    return connection && connection->is_waiting();
  });
  if (oldest == guests_.end()) return false;
  if (const auto connection = oldest->connection.lock()) connection->close();
  erase(oldest);
  return true;
}

bool WebAdmission::evict_any() {
  std::vector<std::pair<std::size_t, std::string>> crowds;
  for (const auto& [address, count] : by_address_) crowds.emplace_back(count, address);
  std::ranges::sort(crowds, std::greater<>());
  return std::ranges::any_of(crowds, [this](const auto& crowd) ALVOR_REQUIRES(mutex_) { return evict_from(crowd.second); });
}

void WebAdmission::erase(Guests::iterator guest) {
  if (const auto count = by_address_.find(guest->address); --count->second == 0) by_address_.erase(count);
  by_connection_.erase(guest->key);
  guests_.erase(guest);
}

}  // namespace alvor
