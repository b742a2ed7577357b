#!/usr/bin/env bash
# Tests the command-line program: its three applications, exit codes, formats and reports.
#
#   test_rco.sh <rco> <cmake> <README.md> <manual> <folder to work in>
set -uo pipefail

rco=$1
cmake=$2
readme=$3
manual=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
rm -rf "$5" && mkdir -p "$5" && cd "$5" || exit 1

failures=0
fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# expect <exit code> <arguments of rco...>; what it prints is in the files out and err
expect() {
  local wanted=$1 code
  shift
  "$rco" "$@" >out 2>err </dev/null
  code=$?
  if [ "$code" -ne "$wanted" ]; then
    fail "rco $*: exit code $code instead of $wanted"
    cat out err
  fi
}

# string(JSON) came with CMake 3.19
has_json=0
printf '{"a": 1}' >probe.json
if [ "$("$cmake" -D FILE=probe.json -D PATH=a -P "$here/json_value.cmake" 2>/dev/null)" = 1 ]; then
  has_json=1
else
  echo "JSON is not checked: CMake is older than 3.19"
fi

# json <keys separated by semicolons>, of the last report
json() { "$cmake" -D FILE=out "-D PATH=$1" -P "$here/json_value.cmake"; }

# json_is <keys> <value>
json_is() {
  [ "$has_json" = 0 ] && return
  local value
  value=$(json "$1") || fail "no JSON, or no $1 in it: $(cat out)"
  [ "$value" = "$2" ] || fail "$1 is $value instead of $2"
}

# json_less <keys> <keys>
json_less() {
  [ "$has_json" = 0 ] && return
  local a b
  a=$(json "$1") && b=$(json "$2") || fail "no JSON, or neither $1 nor $2 in it: $(cat out)"
  awk -v a="$a" -v b="$b" 'BEGIN { exit !(a + 0 < b + 0) }' || fail "$1 = $a, not below $2 = $b"
}

faces_of() { awk '/^[34] / { $1 = $1; print }' "$1"; }
same_faces() {
  [ -n "$(faces_of "$1" | head -1)" ] && cmp -s <(faces_of "$1") <(faces_of "$2") ||
    fail "$1 and $2 do not have the same faces"
}

# make_grid <rows> <corners of a face: 3 or 4> <jitter> <height>: a bumpy square, as OFF
make_grid() {
  awk -v n="$1" -v k="$2" -v jitter="$3" -v height="$4" '
    function noise(i, x) { x = sin(12.9898 * i + 4.1) * 43758.5453; return x - int(x) }
    BEGIN {
      printf "OFF\n%d %d 0\n", (n + 1) * (n + 1), n * n * (k == 3 ? 2 : 1)
      for(i = 0; i <= n; ++i)
        for(j = 0; j <= n; ++j) {
          inside = i > 0 && j > 0 && i < n && j < n
          x = (i + (inside ? jitter * noise(i * (n + 1) + j) : 0)) / n
          y = (j + (inside ? jitter * noise(9999 + i * (n + 1) + j) : 0)) / n
          printf "%.17g %.17g %.17g\n", x, y, height * sin(3 * x) * cos(2 * y)
        }
      for(i = 0; i < n; ++i)
        for(j = 0; j < n; ++j) {
          a = i * (n + 1) + j; b = a + n + 1
          if(k == 4) printf "4 %d %d %d %d\n", a, b, b + 1, a + 1
          else printf "3 %d %d %d\n3 %d %d %d\n", a, b, b + 1, a, b + 1, a + 1
        }
    }'
}

make_grid 20 3 0.4 0.3 >triangles.off
make_grid 16 4 0.35 0.3 >quads.off
make_grid 17 3 0.0 0.3 >reference.off
make_grid 20 3 0.0 0.1 >flat.off

# ---- help and version
for words in --help help "angle --help" "quad -h" "map --help" --version; do
  # shellcheck disable=SC2086
  expect 0 $words
  [ -s out ] && [ ! -s err ] || fail "rco $words says nothing on standard output"
done
expect 0 angle --help
for option in drift-bound number-of-iterations random-seed maximum-running-time energy-tolerance \
              exponent-factor sharp-edges relax-constraints threads json output; do
  grep -q -e "--$option" out || fail "no --$option in the help"
done

# ---- angle, and all formats
expect 0 angle triangles.off -o angle.off
grep -q '^smallest angle' out && grep -q 'result: angle.off' out || fail "no table"
same_faces triangles.off angle.off
expect 0 angle triangles.off -o angle_json.off --json
json_is outcome improved
json_is exit_code 0
json_is number_of_vertices 441
json_less 'before;minimum_angle' 'after;minimum_angle'
json_less 'before;mean_minimum_angle' 'after;mean_minimum_angle'
cmp -s angle.off angle_json.off || fail "two runs differ"
expect 0 angle triangles.off -o angle_1.off --threads 1 --quiet
[ ! -s out ] && [ ! -s err ] || fail "--quiet prints"
cmp -s angle.off angle_1.off || fail "the number of threads decides the result"
for format in obj ply stl OFF; do
  expect 0 angle triangles.off -o "angle.$format"
  # what was written is read, and with the same numbers
  expect 10 angle "angle.$format" -o "again_$format.off" --sharp-edges 0
  [ "$format" = stl ] || same_faces angle.off "again_$format.off"
  cmp -s <(grep ' .* .*\.' angle.off | tr ' ' '\n' | sort) \
         <(grep ' .* .*\.' "again_$format.off" | tr ' ' '\n' | sort) ||
    fail "coordinates changed on the way through $format"
done
expect 0 angle angle.off --reference triangles.off --relax-constraints --sharp-edges 60 \
  --exponent-factor 2 --energy-tolerance 1e-3 --random-seed 7 --number-of-iterations 5 \
  --use-finishing-stage off --maximum-patch-size 300

# ---- a bound in mean edges is the same as that length
expect 0 angle triangles.off -o bound_e.off --drift-bound 0.1e --json
if [ "$has_json" = 1 ]; then
  expect 0 angle triangles.off -o bound.off --drift-bound "$(json drift_bound)" --json
  cmp -s <(cut -c 1-12 bound_e.off) <(cut -c 1-12 bound.off) || fail "0.1e is another bound"
fi
expect 0 angle triangles.off --drift-bound inf --json
json_is drift_bound ''

# ---- quad
expect 0 quad quads.off -o quad.off --json
json_less 'after;standard_deviation_of_edge' 'before;standard_deviation_of_edge'
json_less 'after;standard_deviation_of_corner_angle' 'before;standard_deviation_of_corner_angle'
same_faces quads.off quad.off
expect 0 quad quads.off --reference reference.off -o quad_on.obj --leg-length-factor 1
expect 0 quad quads.off -o quad.ply --energy angle --json
json_less 'after;standard_deviation_of_corner_angle' 'before;standard_deviation_of_corner_angle'
expect 4 quad quads.off -o quad.stl
expect 5 angle quads.off
grep -q 'face 0' err || fail "no face is named"

# ---- map
cat >landmarks.txt <<'END'
# corners of both squares
0 0
20 17  # another

440 323
420 306
220 171
END
expect 0 map flat.off reference.off --landmarks landmarks.txt -o map.off --json
json_less 'after;mean_distortion' 'before;mean_distortion'
same_faces flat.off map.off
expect 0 map flat.off reference.off --initial triangles.off -o map.ply --use-equal-areas no --json
json_less 'after;mean_distortion' 'before;mean_distortion'
make_grid 20 3 0.0 0.28 >near.off
# onto the reference it gets less like the source
expect 14 map near.off reference.off -o map.obj --relax-constraints
grep -q '^not better: mean distortion .* -> .*result: map.obj' out || fail "a map that is worse is not called so"
expect 14 map near.off reference.off --relax-constraints --quiet
expect 14 map near.off reference.off --relax-constraints --json
json_is outcome 'not better'
json_is exit_code 14
json_is 'worse;0' mean_distortion
# ---- soft landmarks: the larger their weight, the closer they come; 0 changes no bit
printf '220 173\n90 76\n' >pulled.txt
expect 0 map flat.off reference.off --initial triangles.off -o let_go.off
grep -q 'of landmarks' out && fail "distances of landmarks that nobody asked for"
last=
for weight in 0 1 10 100; do
  expect 0 map flat.off reference.off --initial triangles.off --landmarks pulled.txt \
    --soft-landmarks $weight -o "soft_$weight.off"
  distance=$(awk '/^distance of landmarks/ { print $NF }' out)
  awk -v a="$distance" -v b="${last:-1e9}" 'BEGIN { exit !(a != "" && a + 0 < b + 0) }' ||
    fail "landmarks of weight $weight are '$distance' away from their counterparts, those before '$last'"
  last=$distance
done
cmp -s let_go.off soft_0.off || fail "landmarks without weight change the result"
cmp -s let_go.off soft_1.off && fail "landmarks with a weight do not change the result"
# they are an objective of their own
expect 0 map flat.off reference.off --initial let_go.off --landmarks pulled.txt --soft-landmarks 100 --json
json_less 'after;mean_landmark_distance' 'before;mean_landmark_distance'
json_less 'after;maximum_landmark_distance' 'before;maximum_landmark_distance'
json_less 'before;mean_distortion' 'after;mean_distortion'
json_is outcome improved
json_is 'worse;0' mean_distortion
expect 0 map flat.off reference.off --landmarks landmarks.txt --soft-landmarks 10 --json
json_is 'before;mean_landmark_distance' 0
# a map to half of the reference is none
awk 'NF == 3 && NR > 2 { $1 /= 2; $3 = 0.3 * sin(3 * $1) * cos(2 * $2) } { print }' \
  triangles.off >half.off
expect 13 map flat.off reference.off --initial half.off -o half_map.off
grep -q '^no usable map: largest uncovered region .* (at most 0.001)' out || fail "bare half of a map: $(cat out)"
expect 13 map flat.off reference.off --initial half.off --json
json_is outcome 'no usable map'
json_is 'flaws;0' largest_uncovered_region
# the face at a corner of the border, whose vertices do not move, stays flipped
awk 'NR == 47 { corner = $0 } { line[NR] = $0 } END { line[3] = corner; for(i = 1; i <= NR; ++i) print line[i] }' \
  triangles.off >corner.off
expect 13 map flat.off reference.off --initial corner.off
grep -q '^no usable map: .*; left: flipped faces [12] (' out || fail "a flipped face is left: $(cat out)"
expect 5 map flat.off reference.off --initial reference.off
expect 3 map flat.off reference.off --landmarks nowhere.txt
for line in '0' '0 0 0' 'a 0' '441 0' '0 324' '-1 0'; do
  printf '# one\n%s\n' "$line" >bad.txt
  expect 3 map flat.off reference.off --landmarks bad.txt
  grep -q 'line 2' err || fail "the line is not named: $(cat err)"
done
printf '# none\n' >empty.txt
expect 3 map flat.off reference.off --landmarks empty.txt
printf '0 0\n20 17\n' >two.txt
expect 5 map flat.off reference.off --landmarks two.txt

# ---- the verdict: what got worse is told, and such a mesh alone is not called better
expect 0 angle triangles.off -o verdict.off
grep -q '^improved' out || fail "no verdict"
grep -q 'left:' out && fail "no defect is left: $(cat out)"
for key in mean_normal_deviation area_turned_above_45 sharp_edges_kept sharp_edges_added volume_change; do
  expect 0 angle triangles.off --number-of-iterations 1 --json
  json_is "before;$key" "$([ "$key" = sharp_edges_kept ] && echo 1 || echo 0)"
  [ "$has_json" = 0 ] || [ -n "$(json "after;$key")" ] || fail "no $key"
done
# ---- nothing to do, out of time
expect 10 angle triangles.off --sharp-edges 0 -o nothing.off --json
json_is outcome 'nothing to do'
json_is worse '[]'
same_faces triangles.off nothing.off
expect 11 angle triangles.off --maximum-running-time 1e-9 --json
json_is status 'time limit'

# ---- bad usage
expect 2
expect 2 angel triangles.off
expect 2 angle
expect 2 angle triangles.off angle.off
expect 2 angle triangles.off --unknown
expect 2 angle triangles.off --random 1
expect 2 angle triangles.off --drift-bound
expect 2 angle triangles.off --leg-length-factor 5
expect 2 quad quads.off --energy beauty
expect 2 quad quads.off --energy angle --leg-length-factor 2
expect 2 quad quads.off --exponent-factor 2
expect 2 map flat.off
expect 2 map flat.off reference.off --landmarks landmarks.txt --initial triangles.off
expect 2 map flat.off reference.off --initial triangles.off --soft-landmarks 1
grep -q 'needs --landmarks' err || fail "no word about --landmarks"
for weight in -1 nan inf strong; do
  expect 2 map flat.off reference.off --landmarks landmarks.txt "--soft-landmarks=$weight"
  grep -q 'soft-landmarks' err || fail "no word about --soft-landmarks"
done
for words in drift-bound=1m drift-bound=-1 drift-bound=e drift-bound=nan random-seed=-1 random-seed=1.5 \
             number-of-iterations=1e30 threads=-1 maximum-running-time=0 energy-tolerance=-1 \
             sharp-edges=200 sharp-edges=x exponent-factor=0 exponent-factor=inf \
             use-finishing-stage=perhaps; do
  expect 2 angle triangles.off "--$words"
  [ -s err ] || fail "no word about --$words"
done
expect 2 angle triangles.off --unknown --json
json_is outcome 'bad usage'

# ---- files that cannot be read or written
expect 3 angle nowhere.off
expect 3 angle .
expect 3 angle landmarks.txt
printf 'no mesh\n' >bad.off
expect 3 angle bad.off --json
json_is exit_code 3
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n' >range.off
expect 3 angle range.off
printf 'OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n' >faceless.off
expect 3 angle faceless.off
expect 4 angle triangles.off -o nowhere/result.off
expect 4 angle triangles.off -o result.vtk
expect 4 angle triangles.off -o result
mkdir -p folder.off
expect 4 angle triangles.off -o folder.off
if [ -e /dev/full ]; then
  for format in off obj ply stl; do
    ln -s /dev/full "full.$format"
    expect 4 angle triangles.off -o "full.$format"
  done
fi

# ---- input that is read, but refused
printf 'OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n3 0 1 2\n3 0 1 3\n3 0 1 4\n' >fan.off
expect 5 angle fan.off
printf 'v 0 0 0\nv 1 0 0\nv 1e300 1 0\nf 1 2 3\n' >far.obj
expect 5 angle far.obj
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n' >nan.off
"$rco" angle nan.off >out 2>err
code=$? # whether the number is read depends on the standard library
[ "$code" = 3 ] || [ "$code" = 5 ] || fail "exit code $code for a coordinate that is no number"
printf 'OFF\n4 2 0\n5 0 0\n6 0 0\n6 1 0\n5 1 0\n3 0 1 2\n3 0 2 3\n' >aside.off
expect 5 angle aside.off --reference triangles.off --json
json_is outcome 'refused input'
grep -q vertex err || fail "no vertex is named"

# ---- the lines of README, of the manual and of the help, on meshes of ours under those names
mkdir -p lines && cd lines || exit 1
cp ../triangles.off elephant.off
expect 0 angle elephant.off -o part.stl --number-of-iterations 1
expect 0 angle elephant.off -o scan.ply --number-of-iterations 1
expect 11 quad ../quads.off -o quads.obj --maximum-running-time 1e-9 # as it is
cp ../flat.off cat.off
cp ../reference.off horse.off
cp ../landmarks.txt cat_horse.txt
for command in angle quad map; do
  "$rco" "$command" --help | grep -E '^  rco .*\.'
done | sed 's/^  rco/rco/' >lines.txt
[ "$(wc -l <lines.txt)" -ge 8 ] || fail "too few examples in the help"
for text in "$readme" "$manual"; do
  grep '^rco ' "$text" >>lines.txt
  [ "$(grep -c '^rco ' "$text")" -ge 3 ] || fail "too few lines in $text"
done
# those that make a file come before those that read it, and leave nothing to do then, or nothing to gain
while read -r _ words; do
  # shellcheck disable=SC2086
  "$rco" $words >out 2>err </dev/null
  code=$?
  [ "$code" = 0 ] || [ "$code" = 10 ] || [ "$code" = 14 ] || fail "rco $words: exit code $code: $(cat err)"
done <lines.txt
cd .. || exit 1

# ---- Ctrl-C: what was reached is saved
make_grid 220 3 0.4 0.3 >large.off
set -m # so that the program does not start with SIGINT ignored
"$rco" angle large.off -o interrupted.off --progress --energy-tolerance 0 >out 2>err </dev/null &
pid=$!
for((i = 0; i < 3000; ++i)); do
  grep -q '^iteration 1:' err && break
  kill -0 "$pid" 2>/dev/null || break
  sleep 0.02
done
kill -INT "$pid" 2>/dev/null
wait "$pid"
code=$?
set +m
[ "$code" = 12 ] || fail "exit code $code after Ctrl-C instead of 12: $(cat err)"
grep -q '^interrupted' out || fail "no word about the interruption"
same_faces large.off interrupted.off
cmp -s large.off interrupted.off && fail "nothing was saved after Ctrl-C"

# ---- and where measuring takes long, Ctrl-C ends that: the result is there already
set -m
"$rco" angle large.off -o measured.off --number-of-iterations 1 >out 2>err </dev/null &
pid=$!
size=0
for((i = 0; i < 3000; ++i)); do
  previous=$size
  size=$({ wc -c <measured.off; } 2>/dev/null || echo 0)
  [ "$size" -gt 0 ] && [ "$size" = "$previous" ] && break
  kill -0 "$pid" 2>/dev/null || break
  sleep 0.02
done
kill -INT "$pid" 2>/dev/null
wait "$pid"
code=$?
set +m
[ "$code" = 12 ] || fail "exit code $code after Ctrl-C while measuring instead of 12: $(cat out err)"
grep -q '^interrupted while measuring; result: measured.off' out || fail "no word about the interruption"
same_faces large.off measured.off

if [ "$failures" -ne 0 ]; then
  echo "$failures failures"
  exit 1
fi
echo "all is well"
