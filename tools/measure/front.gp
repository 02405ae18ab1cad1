# Accuracy against speed on one workload:
# ARG1: the table; ARG2: title; ARG3: where the figures are from.
# Methods with wrong answers are in the upper panel, at their share; the others in the lower one, at their worst error.

csv = ARG1

array Name[23]
do for [n = 1:23] { Name[n] = '' }
leastWrong = 0.2; worst = 1
min(a, b) = a < b ? a : b
max(a, b) = a > b ? a : b
note(wrong) = (Name[column('linetype')] = strcol('name'), worst = max(worst, column('worst_error')), \
               leastWrong = wrong > 0 ? min(leastWrong, wrong) : leastWrong, column('us'))
stats csv using (note(column('wrong_percent'))) nooutput
set xrange [STATS_min / 1.5 : STATS_max * 1.5]
# Releases of gnuplot choose ticks of short logarithmic axes differently.
set xtics 10
if (STATS_max < 500 * STATS_min) {
  set xtics ()
  do for [e = -3:7] { set xtics add (10.0**e, 2 * 10.0**e, 5 * 10.0**e) }
}

us(n) = column('linetype') == n ? column('us') : NaN
wrongOr(otherwise) = column('wrong_percent') > 0 ? column('wrong_percent') : otherwise
errorOr(otherwise) = column('wrong_percent') > 0 ? otherwise : column('worst_error')
markSize(n) = column('size') > 0 ? 0.4 + 0.1 * log(column('size')) : 1.1

others = 0
do for [n = 6:20] { others = others || Name[n] ne '' }
set label 1 ARG3

set multiplot
set logscale xy
set lmargin at screen 0.12
set rmargin at screen 0.74

set tmargin at screen 0.88
set bmargin at screen 0.515
set title ARG2
set ylabel 'wrong answers, % of queries'
set yrange [leastWrong / 1.3 : 100]
set ytics (0.001, 0.01, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
set format x ''
set key title "Cyber Radar (filled)"
# The front leaves the panels: below, to methods without wrong answers; above, from those with some.
plot for [n = 1:20] csv using (us(n)):(wrongOr(NaN)):(markSize(n)) with linespoints linetype n pointsize variable notitle, \
     csv using (us(21)):(wrongOr(NaN)) with points linetype 21 notitle, \
     csv using (us(21)):(wrongOr(1e-9)) with steps linetype 21 notitle, \
     keyentry with linespoints linetype 21 title 'on the front', \
     for [n = 1:5] keyentry with linespoints linetype n title Name[n]

set tmargin at screen 0.475
set bmargin at screen 0.11
unset title
unset label 1
set xlabel 'microseconds per query; larger marks: more pixels, rays or steps'
set ylabel 'worst error, in sensor sizes'
unset mytics
set yrange [3e-14 : 10 * worst]
set ytics 100
set ytics add ("≤ 1e-13" 1e-13)
set format '%g'
set key title (others ? 'Other libraries (hollow)' : '')
plot for [n = 1:20] csv using (us(n)):(errorOr(NaN)):(markSize(n)) with linespoints linetype n pointsize variable notitle, \
     csv using (us(21)):(errorOr(NaN)) with points linetype 21 notitle, \
     csv using (us(21)):(errorOr(1e200)) with steps linetype 21 notitle, \
     for [n = 6:20] keyentry with linespoints linetype n title Name[n]
