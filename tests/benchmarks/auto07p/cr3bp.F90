! The circular restricted three-body problem in space for AUTO-07p: U = (x, y, z, vx, vy, vz) as in docs/systems.md, Earth and Moon.
! PAR(1) = lambda adds lambda v to the accelerations and is 0 on families of periodic orbits (IPS = 2); PAR(3) is the energy H.
! With the environment variable ORBWEAVER_ORBITS every orbit's U(0) and period are appended to that file, with all digits.

SUBROUTINE FUNC(NDIM,U,ICP,PAR,IJAC,F,DFDU,DFDP)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM, IJAC, ICP(*)
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(OUT) :: F(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: DFDU(NDIM,*), DFDP(NDIM,*)
  DOUBLE PRECISION, PARAMETER :: mu=0.01215058560962404d0
  DOUBLE PRECISION d1(3),d2(3),s1,s2,g1,g2,h1,h2
  INTEGER i,j

  d1=U(1:3); d1(1)=d1(1)+mu
  d2=U(1:3); d2(1)=d2(1)-1+mu
  s1=SUM(d1*d1); s2=SUM(d2*d2)
  g1=(1-mu)/(s1*SQRT(s1)); g2=mu/(s2*SQRT(s2))
  F(1:3)=U(4:6)
  F(4:6)=-g1*d1-g2*d2+PAR(1)*U(4:6)
  F(4)=F(4)+2*U(5)+U(1)
  F(5)=F(5)-2*U(4)+U(2)
  IF(IJAC==0)RETURN

  h1=3*g1/s1; h2=3*g2/s2
  DFDU(1:6,1:6)=0
  DO j=1,3
     DFDU(j,3+j)=1
     DO i=1,3
        DFDU(3+i,j)=h1*d1(i)*d1(j)+h2*d2(i)*d2(j)
     ENDDO
     DFDU(3+j,j)=DFDU(3+j,j)-g1-g2
     DFDU(3+j,3+j)=PAR(1)
  ENDDO
  DFDU(4,1)=DFDU(4,1)+1; DFDU(5,2)=DFDU(5,2)+1
  DFDU(4,5)=2; DFDU(5,4)=-2
  IF(IJAC==1)RETURN
  DFDP(1:3,1)=0
  DFDP(4:6,1)=U(4:6)
END SUBROUTINE FUNC

SUBROUTINE STPNT(NDIM,U,PAR,T)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(INOUT) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(IN) :: T
  PAR(1)=0
  U=0
END SUBROUTINE STPNT

SUBROUTINE PVLS(NDIM,U,PAR)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: PAR(*)
  DOUBLE PRECISION, PARAMETER :: mu=0.01215058560962404d0
  DOUBLE PRECISION, EXTERNAL :: GETP
  CHARACTER(256) path
  DOUBLE PRECISION swing
  INTEGER i
  PAR(3)=SUM(U(4:6)**2)/2-SUM(U(1:2)**2)/2-(1-mu)/SQRT((U(1)+mu)**2+U(2)**2+U(3)**2) &
       -mu/SQRT((U(1)-1+mu)**2+U(2)**2+U(3)**2)
  IF(GETP('NTS',0,U)<=1.5d0 .OR. SUM(ABS(U(2:6)))<1d-14)THEN
     ! At L1: the periods of small oscillations in the plane, PAR(6), and out of it, PAR(7), which is the longer one.
     PAR(6)=HUGE(1d0); PAR(7)=0
     DO i=1,6
        IF(GETP('EIG',2*i,U)>1d-5 .AND. ABS(GETP('EIG',2*i-1,U))<1d-6)THEN
           swing=8*ATAN(1d0)/GETP('EIG',2*i,U)
           PAR(6)=MIN(PAR(6),swing); PAR(7)=MAX(PAR(7),swing)
        ENDIF
     ENDDO
     RETURN
  ENDIF
  CALL GET_ENVIRONMENT_VARIABLE('ORBWEAVER_ORBITS',path)
  IF(path==' ')RETURN
  OPEN(77,FILE=path,POSITION='APPEND')
  WRITE(77,'(7ES25.16E3)')U,PAR(11)
  CLOSE(77)
END SUBROUTINE PVLS

SUBROUTINE BCND
END SUBROUTINE BCND

SUBROUTINE ICND
END SUBROUTINE ICND

SUBROUTINE FOPT
END SUBROUTINE FOPT
