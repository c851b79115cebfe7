"""Rows and columns of the arrays of a CableBatch."""

# rows of the elements' constants: L, 1/L, EA L, EI L, damping D_a L and D_b L, rhoA L/420, damping/rhoA
LENGTH, INV_L, EA_L, EI_L, DA_L, DB_L, MASS, VISCOUS = range(8)
#: First row of the curvatures in the reference strains.
CURVATURE = 10
# columns of the groups: first chunk and end, paper's strains or not, first row of gp, numbers of axial and of
# bending Gauss points, which damping there is, whether there are reference strains
BEGIN, END, PAPER, FIRST, AXIAL, BENDING, DAMPED, CURVED = range(8)
#: Bits of the column ``damped`` of the groups.
VISCOUSLY, AXIALLY, IN_BENDING, IN_SLOPE = 1, 2, 4, 8
