#include "bench/furniture.h"
#include "bench/office_room.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace alvor::bench {

namespace {

constexpr int faces_on_a_board = 5;  // the faces of a box without its bottom

/// A row in which boxes may stand, starting at `place` along x, with their backs at z = 0.
struct Board {
  Place place;
  double length, depth, height;
  double filled = 0;
};

struct Furnishing {
  ObjWriter& obj;
  Place room;
  Chance& chance;
  std::vector<Board> boards;

  Place at(const Place& inner) const { return placed_in(room, inner); }
};

void add_screen(ObjWriter& obj, Place place) {
  obj.stand_at(place);
  obj.box("plastic", {-0.12, 0, -0.08}, {0.12, 0.015, 0.08}, bottom);
  obj.box("plastic", {-0.03, 0.015, -0.015}, {0.03, 0.12, 0.015}, bottom | top);
  obj.box("plastic", {-0.27, 0.12, -0.02}, {0.27, 0.45, 0.02});
}

void add_workplace(Furnishing& in, double x) {
  constexpr double top_y = 0.74;
  const double desk_x = x + in.chance.between(-0.08, 0.08);
  in.obj.numbered_object("desk");
  add_table(in.obj, "beech", in.at({desk_x, 4.55}), 1.5, 0.75, top_y);
  add_screen(in.obj, in.at({desk_x, 4.7, in.chance.between(-15, 15), top_y}));
  in.obj.stand_at(in.at({desk_x, 4.32, in.chance.between(-6, 6), top_y}));
  in.obj.box("plastic", {-0.22, 0, -0.07}, {0.22, 0.02, 0.07}, bottom);
  const char* seat = in.chance.below(2) ? "blue" : "charcoal";
  in.obj.numbered_object("chair");
  add_chair(in.obj, seat, in.at({desk_x + in.chance.between(-0.1, 0.1), 3.85, in.chance.between(-30, 30)}));
  in.boards.push_back({in.at({desk_x + 0.35, 4.5, 0, top_y}), 0.35, 0.25, 0.2});
}

/// Adds a shelf with its back at z = 0 of its place.
void add_shelf(Furnishing& in, const Place& inner) {
  constexpr double wide = 0.9, tall = 2.0, deep = 0.32, thick = 0.025, step = 0.39;
  in.obj.numbered_object("shelf");
  in.obj.stand_at(in.at(inner));
  for (const double x : {0.0, wide - thick}) in.obj.box("beech", {x, 0, 0}, {x + thick, tall, deep}, bottom);
  in.obj.box("beech", {thick, 0, 0.005}, {wide - thick, tall - 0.005, 0.02}, bottom | x_low | x_high);
  for (int board = 0; board < 5; ++board) {
    const double y = 0.06 + board * step;
    in.obj.box("beech", {thick, y, 0.02}, {wide - thick, y + thick, deep}, x_low | x_high | z_low);
    in.boards.push_back({placed_in(in.at(inner), {thick + 0.01, 0.03, 0, y + thick}), wide - 2 * thick - 0.02, 0.27, 0.33});
  }
}

void add_low_shelf(Furnishing& in) { add_shelf(in, {0.02, 2.1, 90}); }
void add_high_shelf(Furnishing& in) { add_shelf(in, {0.02, 3.1 + in.chance.between(0, 0.2), 90}); }
void add_far_shelf(Furnishing& in) { add_shelf(in, {room_wide - 0.02, 2.3 + in.chance.between(0, 0.08), -90}); }

void add_cupboard(Furnishing& in) {
  const Place place = in.at({0.4 + in.chance.between(0, 0.6), 0.02});
  in.obj.numbered_object("cupboard");
  in.obj.stand_at(place);
  in.obj.box("steel", {0, 0, 0}, {1.2, 1.0, 0.45}, bottom | top);
  in.obj.box("beech", {-0.01, 1.0, 0}, {1.21, 1.03, 0.48});
  // The doors cover the whole front; of what they cover only narrow joints are visible.
  for (const double x : {0.002, 0.601}) in.obj.box("steel", {x, 0, 0.45}, {x + 0.597, 1.0, 0.468}, bottom | top | z_low);
  in.boards.push_back({placed_in(place, {0.1, 0.05, 0, 1.03}), 1.0, 0.3, 0.35});
}

void add_meeting(Furnishing& in) {
  const double x = 2.15 + in.chance.between(-0.05, 0.05);
  in.obj.numbered_object("meeting");
  add_table(in.obj, "beech", in.at({x, 1.75}), 0.9, 0.9, 0.72);
  for (const double side : {-1.0, 1.0})
    add_chair(in.obj, "charcoal", in.at({x + 0.8 * side, 1.75, -90 * side + in.chance.between(-15, 15)}));
}

void add_left_workplace(Furnishing& in) { add_workplace(in, 1.05); }
void add_right_workplace(Furnishing& in) { add_workplace(in, 2.95); }

struct Piece {
  int faces;
  void (*add)(Furnishing&);
};

bool add_box(Furnishing& in, Board& board) {
  constexpr std::array colours{"red", "green", "blue", "yellow", "paper", "charcoal", "card"};
  const double thick = in.chance.between(0.05, 0.11);
  if (board.filled + thick > board.length) return false;
  in.obj.stand_at(board.place);
  in.obj.box(colours[static_cast<std::size_t>(in.chance.below(colours.size()))], {board.filled, 0, 0},
             {board.filled + thick, board.height * in.chance.between(0.7, 1), board.depth * in.chance.between(0.8, 1)}, bottom);
  board.filled += thick + (in.chance.below(8) ? 0.003 : 0.08);
  return true;
}

/// Puts one box on each board in turn, so that none stays empty beside a full one.
void fill_boards(Furnishing& in, int face_limit) {
  for (std::size_t turn = 0; !in.boards.empty() && in.obj.face_count() + faces_on_a_board <= face_limit; ++turn) {
    const std::size_t board = turn % in.boards.size();
    if (!add_box(in, in.boards[board])) in.boards.erase(in.boards.begin() + static_cast<std::ptrdiff_t>(board));
  }
}

/// Shuffles the pieces, all but the first, which is the workplace.
void shuffle(std::span<Piece> pieces, Chance& chance) {
  for (int last = static_cast<int>(pieces.size()) - 1; last > 1; --last)
    std::swap(pieces[static_cast<std::size_t>(last)], pieces[static_cast<std::size_t>(1 + chance.below(last))]);
}

}  // namespace

void furnish(ObjWriter& obj, const Place& room, int face_limit, Chance& chance) {
  std::array<Piece, 7> pieces{{{86, add_left_workplace},
                               {86, add_right_workplace},
                               {28, add_low_shelf},
                               {28, add_high_shelf},
                               {28, add_far_shelf},
                               {16, add_cupboard},
                               {110, add_meeting}}};
  shuffle(pieces, chance);
  Furnishing in{obj, room, chance, {{placed_in(room, {room_wide - 0.03, 3.45, -90}), 0.75, 0.35, 0.4}}};
  // Leaves out one piece, which differs from room to room.
  for (const Piece& piece : std::span(pieces).first(pieces.size() - 1))
    if (obj.face_count() + piece.faces <= face_limit) piece.add(in);
  obj.numbered_object("things");
  fill_boards(in, face_limit);
}

}  // namespace alvor::bench
