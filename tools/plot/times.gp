# Times of several methods as the work grows:
#   gnuplot tools/plot/style.gp -c tools/plot/times.gp docs/chart/points.csv growth-boxes 'More boxes' boxes 'an H100' > boxes.svg

csv = ARG1; chart = ARG2

array Name[23]
do for [n = 1:23] { Name[n] = '' }
isHere(n) = strcol('chart') eq chart && (n == 0 || column('linetype') == n)
# A tic for each x of a point: 1000, 16k.
tics = ''
short(x) = gprintf(x < 1e4 ? '%g' : '%.0s%c', x)
note(x) = (Name[column('linetype')] = strcol('name'), tics = tics . sprintf(", '%s' %g", short(x), x), x)
stats csv using (isHere(0) ? note(column('x')) : NaN) nooutput
set xrange [STATS_min / 1.15 : STATS_max * 1.15]
eval 'set xtics (' . tics[3:] . ')'

set xtics font ',11'
set logscale xy
set title ARG3
set xlabel ARG4
set ylabel 'microseconds per query'
set label 1 ARG5
others = 0
do for [n = 6:20] { others = others || Name[n] ne '' }
set key title (others ? "filled: Cyber Radar\nhollow: other libraries" : '')
plot for [n = 1:23] csv using (isHere(n) ? column('x') : NaN):(column('us')) with linespoints linetype n title Name[n]
